// How the power of the errors spreads over spatial frequencies.

// Spectra of the samplers shown at a sample count, divided by scale(spectrum): points and the level of
// white noise.
function spectrumLines(scene, spp, scale) {
  const lines = [];
  scene.samplers.forEach((s, i) => {
    const rung = s.rungs.find((r) => r.spp === spp);
    if (!shown(i) || !rung || !rung.spectrum || !(rung.spectrum.white_noise > 0)) return;
    const by = scale(rung.spectrum);
    const points = rung.spectrum.power.map((p, k) => ({ x: scene.frequencies[k], y: p / by, series: i, lines: [
      `${s.sampler}, ${spp} spp`, `${exact(scene.frequencies[k])} cycles per pixel`, `power ${exact(p)}`,
      `${exact(p / rung.spectrum.white_noise)} of white noise`] })).filter((p) => p.y > 0);
    lines.push({ sampler: s.sampler, index: i, points: points, white: rung.spectrum.white_noise / by });
  });
  return lines;
}

function spectrumPlot(grid, scene, spp, text, scale) {
  const lines = spectrumLines(scene, spp, scale);
  const points = [].concat(...lines.map((line) => line.points));
  if (!points.length) {
    grid.append("div").attr("class", "plot").append("p").text("No error above zero was measured.");
    return;
  }
  const whites = new Map(lines.map((line) => [line.white, colour(line.index)]));
  plot(grid, {
    title: text.title, file: `${scene.label}-spectrum-${spp}spp-${text.name}`,
    x: logAxis(scene.frequencies, 1.05), y: logAxis(points.map((p) => p.y).concat([...whites.keys()]), 1.3),
    xLabel: "Spatial frequency (cycles per pixel)", yLabel: text.label,
    points: points, series: samplerNames,
    paint: (layer, x, y, size) => {
      whites.forEach((stroke, white) => layer.append("line")
        .attr({ class: "white", x1: 0, x2: size.width, y1: y(white), y2: y(white) })
        .style("stroke", whites.size < lines.length ? "var(--muted)" : stroke));
      lines.forEach((line) => layer.append("path")
        .attr({ class: "median", "data-sampler": line.sampler, "stroke-dasharray": dash(line.index) })
        .style("stroke", colour(line.index))
        .attr("d", d3.svg.line().x((p) => x(p.x)).y((p) => y(p.y))(line.points)));
    },
  });
}

function spectrumPlots(section, scene) {
  if (!scene.frequencies.length) return;
  section.append("h3").text("Spectrum of the error");
  const counts = Array.from(new Set([].concat(...scene.samplers.map((s) => s.rungs.map((r) => r.spp))))).sort((a, b) => b - a);
  const controls = section.append("div").attr("class", "controls");
  const select = controls.append("label").text("Samples per pixel ").append("select");
  select.selectAll("option").data(counts).enter().append("option").text((spp) => spp);
  const grid = section.append("div").attr("class", "plots");
  section.append("p").text(
    "Dotted: white noise of the same total power, which has as much at every frequency. A line above its dotted one " +
    "on the left is red error: power at low frequencies, blotches and bands many pixels wide. That is structure, and it " +
    "is seen, from afar too. A line below it on the left and above it on the right is blue error: fine grain, which the " +
    "eye blurs away. Of two samplers with the same RMSE, the redder one looks worse.");
  section.append("p").attr("class", "muted").text(
    "Power of the error of luminance over rings of frequencies, averaged over the seeds' images (not that of their mean); " +
    "both axes logarithmic.");
  const draw = () => {
    const spp = Number(select.property("value"));
    grid.html("");
    spectrumPlot(grid, scene, spp, { title: "Power", name: "power", label: "Power (radiance²)" }, () => 1);
    spectrumPlot(grid, scene, spp, { title: "Power relative to white noise", name: "relative", label: "Power / white noise" },
      (spectrum) => spectrum.white_noise);
  };
  select.on("change", draw);
  drawNowAndLater(draw);
}
