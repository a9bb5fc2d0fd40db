// Errors against CPU time and against samples per pixel.

// What a plot of errors has across: where its rungs, and single renders, stand.
const cpuTime = { name: "time", label: "CPU time (s)", rung: (r) => r.cpu_seconds.median, run: (r, run) => run.cpu_seconds };
const samples = { name: "spp", label: "Samples per pixel", rung: (r) => r.spp, run: (r) => r.spp, ticks: summary.spp };

// Rungs and renders of one sampler as points that can be hovered.
function errorPoints(sampler, i, across) {
  const name = selection.metric.name, title = heading(selection.metric);
  const points = [];
  sampler.rungs.forEach((rung) => {
    const what = `${sampler.sampler}, ${rung.spp} spp`;
    points.push({ x: across.rung(rung), y: rung[name].median, series: i, lines: [
      `${what}, median of ${rung.runs.length} seeds`, `${title} ${exact(rung[name].median)}`,
      `5–95 %: ${exact(rung[name].p5)} to ${exact(rung[name].p95)}`, `CPU time ${exact(rung.cpu_seconds.median)} s`] });
    rung.runs.forEach((run) => points.push({ x: across.run(rung, run), y: run[name], series: i, lines: [
      `${what}, seed ${run.seed}`, `${title} ${exact(run[name])}`, `CPU time ${exact(run.cpu_seconds)} s`] }));
  });
  return points.filter((p) => p.x > 0 && p.y !== null);
}

// Band, seeds, median line and median marks of one sampler.
function errorCurve(layer, sampler, i, across, x, y) {
  const name = selection.metric.name;
  // What is not finite stands nowhere.
  const rungs = sampler.rungs.filter((r) => across.rung(r) > 0 && r[name].median !== null);
  const at = (r) => x(across.rung(r));
  layer.append("path").attr("class", "band").style("fill", colour(i)).attr("d", d3.svg.area()
    .x(at).y0((r) => y(r[name].p5)).y1((r) => y(r[name].p95))(rungs));
  rungs.forEach((r) => {
    r.runs.filter((run) => run[name] !== null).forEach((run) => layer.append("circle").attr({ class: "seed", r: 2.6, cx: x(across.run(r, run)), cy: y(run[name]),
      "data-sampler": sampler.sampler, "data-spp": r.spp, "data-seed": run.seed }).style("fill", colour(i)));
  });
  layer.append("path").attr({ class: "median", "data-sampler": sampler.sampler, "stroke-dasharray": dash(i) })
    .style("stroke", colour(i)).attr("d", d3.svg.line().x(at).y((r) => y(r[name].median))(rungs));
  rungs.forEach((r) => layer.append("path").attr({ d: d3.svg.symbol().type(shape(i)).size(64),
    transform: `translate(${at(r)},${y(r[name].median)})` }).style("fill", colour(i)));
}

function errorPlot(grid, scene, across) {
  const metric = selection.metric;
  const points = [].concat(...scene.samplers.map((s, i) => (shown(i) ? errorPoints(s, i, across) : [])));
  const values = points.map((p) => p.y);
  // Metrics of which higher is better, such as SSIM, end at 1: no logarithm makes sense of them.
  const log = metric.lower_is_better;
  if (!points.length || (log && !values.some((v) => v > 0))) {
    grid.append("div").attr("class", "plot").append("p").text(points.length ? "All values are 0." : "No sampler is chosen.");
    return;
  }
  plot(grid, {
    title: `${heading(metric)} against ${across === cpuTime ? "CPU time" : "samples per pixel"}`,
    file: `${scene.label}-${metric.name}-${across.name}`,
    x: logAxis(points.map((p) => p.x), 1.2, across.ticks),
    y: log ? logAxis(values, 1.25) : linearAxis(values),
    xLabel: across.label, yLabel: withUnit(metric),
    points: points, series: samplerNames,
    paint: (layer, x, y) => scene.samplers.forEach((s, i) => { if (shown(i)) errorCurve(layer, s, i, across, x, y); }),
  });
  const zeros = values.filter((v) => v === 0).length;
  if (log && zeros) {
    grid.select(".plot:last-child").append("p").attr("class", "muted").text(
      `${zeros} points have the value 0, which has no logarithm: they stand on the lower edge.`);
  }
}

function errorPlots(section, scene) {
  section.append("h3").text("Error against CPU time and samples");
  const note = section.append("p").attr("class", "muted");
  const grid = section.append("div").attr("class", "plots");
  drawNowAndLater(() => {
    note.text("Median over seeds (line), 5–95 % (band), single renders (dots). " + (selection.metric.lower_is_better
      ? "Both axes are logarithmic; lower left is better. "
      : `For ${heading(selection.metric)} higher is better: upper left. Time and samples are logarithmic. `) +
      "Point at a dot for its values; drag a rectangle to zoom, double-click to see all again.");
    grid.html("");
    [cpuTime, samples].forEach((across) => errorPlot(grid, scene, across));
  });
}
