// What the reader chose to see: one metric, some of the samplers. Plots and tables redraw themselves
// when that changes.

const page = d3.select("#report");
const { summary, images: imageIndex, magma, colours, series_per_dash: seriesPerDash } =
  JSON.parse(document.getElementById("data").textContent);

const headings = {};
summary.table.forEach((column) => { headings[column.name] = column.heading; });
const heading = (m) => headings[m.name] || m.title;
const withUnit = (m) => heading(m) + (m.unit ? ` (${m.unit})` : "");

const samplerNames = summary.scenes.length ? summary.scenes[0].samplers.map((s) => s.sampler) : [];
const selection = {
  metric: summary.metrics.find((m) => m.name === "flip_ldr") || summary.metrics[0],
  hidden: new Set(),  // places in samplerNames
};
const redraws = [];
const shown = (i) => !selection.hidden.has(i);

function drawNowAndLater(draw) {
  redraws.push(draw);
  draw();
}
const redrawAll = () => redraws.forEach((redraw) => redraw());

// How sampler i looks: colours are variables of the style sheet, which dark pages lighten.
const shapes = ["circle", "square", "triangle-up", "diamond", "triangle-down", "cross"];
const dashes = [null, "9 4", "9 3 2 3"];
const colour = (i) => `var(--series-${i % colours.length})`;
const shape = (i) => shapes[i % shapes.length];
const dash = (i) => dashes[Math.floor(i / seriesPerDash) % dashes.length];

function defineColours() {
  const define = (value) => colours.map((c, i) => `--series-${i}: ${value(c)};`).join(" ");
  page.append("style").text(`:root { ${define((c) => c)} }
    @media (prefers-color-scheme: dark) { :root:not(.paper) { ${define((c) => `color-mix(in srgb, ${c}, white 28%)`)} } }`);
}

// A piece of sampler i's line with its marker.
function sample(parent, i) {
  const svg = parent.append("svg").attr({ class: "sample", width: 34, height: 14, viewBox: "0 0 34 14", "aria-hidden": "true" });
  svg.append("line").attr({ x1: 0, x2: 34, y1: 7, y2: 7, "stroke-width": 2.2, "stroke-dasharray": dash(i) })
    .style("stroke", colour(i));
  svg.append("path").attr({ d: d3.svg.symbol().type(shape(i)).size(64), transform: "translate(17,7)" })
    .style("fill", colour(i));
}

// Stays at the top of the window: it is for the plots and tables of all scenes, and it is their legend.
function selectionBar() {
  const bar = page.append("div").attr({ class: "bar", role: "group", "aria-label": "What plots and tables show" });
  const select = bar.append("label").text("Metric ").append("select").attr("id", "metric");
  select.selectAll("option").data(summary.metrics).enter().append("option").attr("value", (m) => m.name)
    .property("selected", (m) => m === selection.metric)
    .text((m) => m.title + (m.unit ? ` (${m.unit})` : "") + (m.lower_is_better ? "" : ", higher is better"));
  select.on("change", () => {
    selection.metric = summary.metrics.find((m) => m.name === select.property("value"));
    redrawAll();
  });
  const chips = bar.append("div").attr("class", "chips");
  const items = chips.selectAll("button").data(samplerNames).enter().append("button")
    .attr({ type: "button", class: "chip", title: "Show or hide; with Shift: this one alone" });
  items.each(function (name, i) { sample(d3.select(this), i); });
  items.append("span").text((name) => name);
  const mark = () => items.attr("aria-pressed", (name, i) => String(shown(i)));
  items.on("click", (name, i) => {
    const others = samplerNames.map((_, k) => k).filter((k) => k !== i);
    if (d3.event.shiftKey) selection.hidden = new Set(shown(i) && !others.some(shown) ? [] : others);
    else if (!selection.hidden.delete(i)) selection.hidden.add(i);
    mark();
    redrawAll();
  });
  mark();
}
