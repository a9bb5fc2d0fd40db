// One chart: axes, hovering, zooming, and a file of it. What is drawn inside is the caller's.

// 1, 2 and 5 times powers of ten inside the domain; powers of ten alone where that is too many,
// and evenly spaced values where it is too few.
function logTicks(domain) {
  const make = (steps) => {
    const list = [];
    for (let e = Math.floor(Math.log10(domain[0])); e <= Math.log10(domain[1]) + 1; ++e) {
      for (const s of steps) {
        const v = s * Math.pow(10, e);
        if (v >= domain[0] * 0.9999 && v <= domain[1] * 1.0001) list.push(v);
      }
    }
    return list;
  };
  const fine = make([1, 2, 5]);
  if (fine.length < 3) return d3.scale.linear().domain(domain).ticks(4).filter((v) => v > 0);
  return fine.length <= 9 ? fine : make([1]);
}

// An axis: its scale over the whole domain, and which values are written beside it.
function logAxis(values, padding, ticks) {
  const extent = d3.extent(values.filter((v) => v > 0));
  const scale = d3.scale.log().domain([extent[0] / padding, extent[1] * padding]);
  return { scale: scale, log: true, ticks: (domain) => {
    const inside = (ticks || []).filter((v) => v >= domain[0] && v <= domain[1]);
    return inside.length > 1 ? inside : logTicks(domain);
  } };
}
function linearAxis(values) {
  const [low, high] = d3.extent(values);
  const padding = 0.08 * (high - low) || 0.01;
  const scale = d3.scale.linear().domain([low - padding, high + padding]);
  return { scale: scale, log: false, ticks: (domain) => d3.scale.linear().domain(domain).ticks(6) };
}

const margin = { left: 84, right: 14, top: 8, bottom: 46 };
const hoverReach = 36;  // pixels
let plotCount = 0;

// Draws `spec`: title; x, y (axes); xLabel, yLabel; file (name without extension); paint(layer, x, y),
// where x and y place values in pixels; points {x, y, series, lines}, which can be hovered; series, the
// samplers for the legend of the file. Zooms by dragging, Ctrl and wheel, buttons and keys.
function plot(parent, spec) {
  const box = parent.append("div").attr("class", "plot");
  const bar = box.append("div").attr("class", "plot-bar");
  bar.append("h4").text(spec.title);
  const width = Math.max(180, box.node().clientWidth - 26 - margin.left - margin.right);
  const height = Math.round(Math.min(320, Math.max(220, 0.62 * width)));
  const scales = { x: spec.x.scale.copy().range([0, width]), y: spec.y.scale.copy().range([height, 0]) };
  const home = { x: scales.x.domain(), y: scales.y.domain() };
  // Zero has no logarithm and stands on the edge.
  const place = {
    x: (v) => (v > 0 || !spec.x.log ? scales.x(v) : 0),
    y: (v) => (v > 0 || !spec.y.log ? scales.y(v) : height),
  };

  const size = { width: width + margin.left + margin.right, height: height + margin.top + margin.bottom };
  const svg = box.append("svg").attr({ viewBox: `0 0 ${size.width} ${size.height}`, width: size.width, height: size.height,
    tabindex: 0, role: "img", "aria-label": `${spec.title}: ${spec.yLabel} against ${spec.xLabel}. ` +
    "Arrow keys go through the points, + and - zoom, 0 shows all." });
  const clip = `clip-${++plotCount}`;
  svg.append("clipPath").attr("id", clip).append("rect").attr({ x: -1, y: -1, width: width + 2, height: height + 2 });
  const inner = svg.append("g").attr("transform", `translate(${margin.left},${margin.top})`);
  const axes = inner.append("g");
  const layer = inner.append("g").attr("clip-path", `url(#${clip})`);
  const halo = inner.append("circle").attr({ class: "halo", r: 7 }).style("display", "none");
  const drag = inner.append("g").attr("class", "drag");
  const tip = box.append("div").attr({ class: "tip", role: "status" }).style("display", "none");

  function drawAxes() {
    axes.html("");
    spec.x.ticks(scales.x.domain()).forEach((v) => {
      axes.append("line").attr({ class: "grid", x1: place.x(v), x2: place.x(v), y1: 0, y2: height });
      axes.append("text").attr({ x: place.x(v), y: height + 18, "text-anchor": "middle" }).text(number(v));
    });
    spec.y.ticks(scales.y.domain()).forEach((v) => {
      axes.append("line").attr({ class: "grid", x1: 0, x2: width, y1: place.y(v), y2: place.y(v) });
      axes.append("text").attr({ x: -8, y: place.y(v) + 4, "text-anchor": "end" }).text(number(v));
    });
    axes.append("rect").attr({ class: "frame", width: width, height: height });
    axes.append("text").attr({ class: "label", x: width / 2, y: height + 39, "text-anchor": "middle" }).text(spec.xLabel);
    axes.append("text").attr({ class: "label", transform: `translate(-70,${height / 2}) rotate(-90)`, "text-anchor": "middle" })
      .text(spec.yLabel);
  }

  // Points, as far as they are inside the axes.
  const inside = () => spec.points.filter((p) => place.x(p.x) >= -1 && place.x(p.x) <= width + 1 &&
    place.y(p.y) >= -1 && place.y(p.y) <= height + 1);
  let hovered = null;
  function show(point) {
    hovered = point;
    halo.style("display", point ? null : "none");
    tip.style("display", point ? null : "none");
    if (!point) return;
    const at = { x: place.x(point.x), y: place.y(point.y) };
    halo.attr({ cx: at.x, cy: at.y }).style("stroke", colour(point.series));
    tip.html("").selectAll("div").data(point.lines).enter().append("div").text((line) => line);
    const frame = svg.node(), left = frame.offsetLeft + margin.left + at.x;
    const room = box.node().clientWidth - tip.node().offsetWidth - 6;
    tip.style({ left: `${Math.max(6, Math.min(room, left + 12))}px`,
      top: `${Math.max(0, frame.offsetTop + margin.top + at.y - tip.node().offsetHeight - 10)}px` });
  }
  function hover() {
    const [x, y] = d3.mouse(inner.node());
    const distance = (p) => Math.hypot(place.x(p.x) - x, place.y(p.y) - y);
    let nearest = null;
    inside().forEach((p) => { if (!nearest || distance(p) < distance(nearest)) nearest = p; });
    show(nearest && distance(nearest) <= hoverReach ? nearest : null);
  }

  function draw() {
    show(null);
    drawAxes();
    layer.html("");
    spec.paint(layer, place.x, place.y, { width, height });
  }
  function setDomains(x, y) {
    // Closer than this, digits run out.
    const wide = (d, log) => (log ? d[1] / d[0] > 1.0001 : d[1] - d[0] > 1e-9);
    if (!wide(x, spec.x.log) || !wide(y, spec.y.log)) return;
    scales.x.domain(x);
    scales.y.domain(y);
    draw();
  }
  const reset = () => setDomains(home.x, home.y);
  // By `factor` about a place in pixels.
  function zoom(factor, about) {
    const around = (scale, at, ends) => ends.map((end) => scale.invert(at + (end - at) / factor));
    setDomains(around(scales.x, about.x, [0, width]), around(scales.y, about.y, [height, 0]));
  }
  const middle = { x: width / 2, y: height / 2 };

  const brush = d3.svg.brush().x(scales.x).y(scales.y).on("brushend", () => {
    if (brush.empty()) return;
    const [[x0, y0], [x1, y1]] = brush.extent();
    brush.clear()(drag);
    setDomains([x0, x1], [y0, y1]);
  });
  drag.call(brush).on("touchstart.brush", null).on("dblclick", reset)
    .on("mousemove", hover).on("mouseleave", () => show(null)).on("touchstart.hover", hover);
  svg.on("wheel", () => {
    if (!d3.event.ctrlKey) return;
    d3.event.preventDefault();
    const [x, y] = d3.mouse(inner.node());
    zoom(d3.event.deltaY < 0 ? 1.25 : 0.8, { x, y });
  });
  svg.on("keydown", () => {
    const key = d3.event.key;
    if (key === "+" || key === "=") zoom(1.5, middle);
    else if (key === "-") zoom(1 / 1.5, middle);
    else if (key === "0") reset();
    else if (key === "Escape") show(null);
    else if (key === "ArrowRight" || key === "ArrowLeft") {
      const points = inside(), step = key === "ArrowRight" ? 1 : -1;
      const at = points.indexOf(hovered);
      if (points.length) show(points[at < 0 ? 0 : (at + step + points.length) % points.length]);
    } else return;
    d3.event.preventDefault();
    d3.event.stopPropagation();
  });
  const tools = bar.append("div").attr("class", "tools");
  button(tools, "+", "Zoom in", () => zoom(1.5, middle));
  button(tools, "−", "Zoom out", () => zoom(1 / 1.5, middle));
  button(tools, "All", "Show all", reset);
  button(tools, "SVG", "Save this plot as SVG, as it is shown", () => savePlot(svg.node(), spec));
  draw();
}

// The plot as a file of its own: light colours, styles written into the elements, a legend below.
function savePlot(svg, spec) {
  const kept = ["fill", "stroke", "stroke-width", "stroke-dasharray", "opacity", "font-size", "font-family", "display"];
  document.documentElement.classList.add("paper");
  const copy = svg.cloneNode(true);
  const originals = [svg, ...svg.querySelectorAll("*")];
  [copy, ...copy.querySelectorAll("*")].forEach((node, i) => {
    const computed = getComputedStyle(originals[i]);
    kept.forEach((property) => node.style.setProperty(property, computed.getPropertyValue(property)));
  });
  const resolved = (i) => getComputedStyle(document.documentElement).getPropertyValue(`--series-${i % colours.length}`);
  const [width, height] = svg.getAttribute("viewBox").split(" ").slice(2).map(Number);
  const root = d3.select(copy);
  const rows = spec.series.map((name, i) => ({ name, i })).filter((row) => shown(row.i));
  rows.forEach((row, k) => {
    const item = root.append("g").attr("transform", `translate(${margin.left},${height + 14 + 18 * k})`);
    item.append("line").attr({ x1: 0, x2: 34, "stroke-width": 2.2, "stroke-dasharray": dash(row.i), stroke: resolved(row.i) });
    item.append("path").attr({ d: d3.svg.symbol().type(shape(row.i)).size(64), transform: "translate(17,0)", fill: resolved(row.i) });
    item.append("text").attr({ x: 42, y: 4, "font-family": "sans-serif", "font-size": "13px" }).text(row.name);
  });
  document.documentElement.classList.remove("paper");
  const full = height + 14 + 18 * rows.length;
  root.attr({ viewBox: `0 0 ${width} ${full}`, height: full, xmlns: "http://www.w3.org/2000/svg" });
  save(`${fileNameSafe(spec.file)}.svg`, new Blob([new XMLSerializer().serializeToString(copy)], { type: "image/svg+xml" }));
}
