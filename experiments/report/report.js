// Draws the report from the comparison's summary, which stands in the page as JSON.
"use strict";
(function () {
  const data = JSON.parse(document.getElementById("data").textContent);
  const page = d3.select("#report");
  const shapes = ["circle", "square", "triangle-up", "diamond", "triangle-down", "cross"];
  const colour = (i) => `var(--c${i % 7})`;
  const shape = (i) => shapes[i % shapes.length];

  // What the page shows of eleven metrics: the one chosen, redrawn by every function in `redraws`.
  let metric = data.metrics.find((m) => m.name === "flip_ldr") || data.metrics[0];
  const redraws = [];
  const headings = {};
  data.table.forEach((column) => { headings[column.name] = column.heading; });
  const heading = (m) => headings[m.name] || m.title;

  // Numbers with three significant digits, large and small ones as powers of ten.
  const superscripts = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
  const power = (e) => "10" + String(e).split("").map((c) => superscripts[c]).join("");
  function number(v) {
    if (v === 0 || v === null || v === undefined) return v === 0 ? "0" : "–";
    const e = Math.floor(Math.log10(Math.abs(v)) + 1e-9);
    if (e >= -3 && e < 5) return String(Number(v.toPrecision(3)));
    const mantissa = Number((v / Math.pow(10, e)).toFixed(2));
    return mantissa === 1 ? power(e) : `${mantissa} × ${power(e)}`;
  }
  const seconds = (v) => `${number(v)} s`;

  function fact(list, term, text) {
    const box = list.append("div");
    box.append("dt").text(term);
    box.append("dd").text(text);
  }

  function header() {
    page.append("h1").text("Error at equal time: " + data.scenes.map((s) => s.label).join(", "));
    page.append("p").attr("class", "muted").text(
      "How far each sampler's images are from a reference, against the CPU time that the images took.");
    const facts = page.append("dl").attr("class", "facts");
    fact(facts, "Machine", `${data.machine.cpu}, ${data.machine.processors} logical processors`);
    fact(facts, "Kernels", data.isa);
    fact(facts, "Seeds", data.seeds);
    fact(facts, "Samples per pixel", data.spp.join(", "));
    fact(facts, "Date", data.date);
    fact(facts, "Lockstep", data.lockstep);
    page.append("p").text(
      "Time is CPU time, summed over threads, of a complete render: pilot image, its filter and the weights are " +
      "included, loading the scene is not. Every point is a render of its own; samplers took turns, so that a " +
      "disturbance of the machine falls on all alike.");
    if (!data.complete) {
      page.append("p").attr("class", "note").text(
        "Stopped before all seeds were rendered: what follows was measured until then.");
    }
    if (data.verdicts.length > 1) {
      page.append("h3").text("In short");
      page.append("ul").selectAll("li").data(data.verdicts).enter().append("li").text((v) => v.sentence);
    }
  }

  // Stays at the top of the window: it is for the plots and tables of all scenes.
  function metricSelector() {
    const bar = page.append("div").attr("class", "controls bar");
    const select = bar.append("label").text("Metric ").append("select");
    select.selectAll("option").data(data.metrics).enter().append("option").attr("value", (m) => m.name)
      .property("selected", (m) => m === metric)
      .text((m) => m.title + (m.unit ? ` (${m.unit})` : "") + (m.lower_is_better ? "" : ", higher is better"));
    bar.append("span").attr("class", "muted").text("in all plots of error and tables below");
    select.on("change", () => {
      metric = data.metrics.find((m) => m.name === select.property("value"));
      redraws.forEach((redraw) => redraw());
    });
  }

  function legend(parent, scene) {
    const items = parent.append("div").attr("class", "legend").selectAll("span").data(scene.samplers)
      .enter().append("span");
    items.append("svg").attr({ width: 30, height: 14, viewBox: "0 0 30 14" }).each(function (d, i) {
      const svg = d3.select(this);
      svg.append("line").attr({ x1: 0, x2: 30, y1: 7, y2: 7, "stroke-width": 2.2 }).style("stroke", colour(i));
      svg.append("path").attr({ d: d3.svg.symbol().type(shape(i)).size(64), transform: "translate(15,7)" })
        .style("fill", colour(i));
    });
    items.append("span").text((d) => d.sampler + (d.biased ? " (biased)" : ""));
  }

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
    if (fine.length < 2) return d3.scale.linear().domain(domain).ticks(4).filter((v) => v > 0);
    return fine.length <= 9 ? fine : make([1]);
  }

  // An axis: where a value stands, and which values are written beside it. Zero has no logarithm and
  // stands on the edge.
  function logAxis(values, padding, range, ticks) {
    const extent = d3.extent(values.filter((v) => v > 0));
    const scale = d3.scale.log().domain([extent[0] / padding, extent[1] * padding]).range(range);
    return { place: (v) => (v > 0 ? scale(v) : range[0]), ticks: ticks || logTicks(scale.domain()) };
  }
  function linearAxis(values, range) {
    const [low, high] = d3.extent(values);
    const padding = 0.08 * (high - low) || 0.01;
    const scale = d3.scale.linear().domain([low - padding, high + padding]).range(range);
    return { place: scale, ticks: scale.ticks(6) };
  }

  const margin = { left: 84, top: 10 }, width = 400, height = 280;

  // A drawing area with its axes.
  function frame(box, x, y, labels) {
    const svg = box.append("svg").attr({ viewBox: `0 0 ${width + margin.left + 16} ${height + margin.top + 48}`, role: "img",
      "aria-label": `${labels.y} against ${labels.x}` })
      .append("g").attr("transform", `translate(${margin.left},${margin.top})`);
    x.ticks.forEach((v) => {
      svg.append("line").attr({ class: "grid", x1: x.place(v), x2: x.place(v), y1: 0, y2: height });
      svg.append("text").attr({ x: x.place(v), y: height + 18, "text-anchor": "middle" }).text(number(v));
    });
    y.ticks.forEach((v) => {
      svg.append("line").attr({ class: "grid", x1: 0, x2: width, y1: y.place(v), y2: y.place(v) });
      svg.append("text").attr({ x: -8, y: y.place(v) + 4, "text-anchor": "end" }).text(number(v));
    });
    svg.append("rect").attr({ class: "frame", width: width, height: height });
    svg.append("text").attr({ class: "label", x: width / 2, y: height + 40, "text-anchor": "middle" }).text(labels.x);
    svg.append("text").attr({ class: "label", transform: `translate(-62,${height / 2}) rotate(-90)`, "text-anchor": "middle" })
      .text(labels.y);
    return svg;
  }

  // What a plot of errors has across: where its rungs, and single renders, stand.
  const cpuTime = { label: "CPU time (s)", rung: (r) => r.cpu_seconds.median, run: (r, run) => run.cpu_seconds };
  const samples = { label: "Samples per pixel", rung: (r) => r.spp, run: (r) => r.spp, ticks: data.spp };

  // Band, seeds, median line and median marks of one sampler.
  function curve(svg, sampler, i, across, x, y) {
    const rungs = sampler.rungs.filter((r) => across.rung(r) > 0);
    const at = (r) => x.place(across.rung(r));
    const value = (r) => r[metric.name];
    svg.append("path").attr("class", "band").style("fill", colour(i)).attr("d", d3.svg.area()
      .x(at).y0((r) => y.place(value(r).p5)).y1((r) => y.place(value(r).p95))(rungs));
    rungs.forEach((r) => r.runs.filter((run) => across.run(r, run) > 0).forEach((run) => {
      svg.append("circle").attr({ class: "seed", r: 1.8, cx: x.place(across.run(r, run)), cy: y.place(run[metric.name]) })
        .style("fill", colour(i));
    }));
    svg.append("path").attr("class", "median").style("stroke", colour(i)).attr("d", d3.svg.line()
      .x(at).y((r) => y.place(value(r).median))(rungs));
    svg.selectAll(null).data(rungs).enter().append("path").style("fill", colour(i))
      .attr("d", d3.svg.symbol().type(shape(i)).size(58))
      .attr("transform", (r) => `translate(${at(r)},${y.place(value(r).median)})`)
      .append("title").text((r) => `${sampler.sampler}, ${r.spp} spp\n${seconds(r.cpu_seconds.median)} of CPU time\n` +
        `median ${number(value(r).median)}, 5–95 % ${number(value(r).p5)} to ${number(value(r).p95)}`);
  }

  function errorPlot(parent, scene, across) {
    const box = parent.append("div").attr("class", "plot");
    box.append("h4").text(`${heading(metric)} against ${across === samples ? "samples per pixel" : "CPU time"}`);
    const rungs = [].concat(...scene.samplers.map((s) => s.rungs));
    const runs = [].concat(...rungs.map((r) => r.runs.map((run) => ({ x: across.run(r, run), y: run[metric.name] }))));
    const zeros = runs.filter((run) => run.y === 0).length;
    const isLog = metric.lower_is_better;
    if (!runs.length || (isLog && zeros === runs.length)) {
      box.append("p").text(runs.length ? "Every render has the value 0." : "Nothing was rendered.");
      return;
    }
    const values = runs.map((run) => run.y);
    const floor = metric.name === "relmse" ? scene.reference.relmse_estimate : null;
    const shown = floor && floor > d3.min(values.filter((v) => v > 0)) / 30;
    const x = logAxis(runs.map((run) => run.x), 1.25, [0, width], across.ticks && across.ticks.length < 10 ? across.ticks : null);
    const y = isLog ? logAxis(shown ? values.concat(floor) : values, 1.3, [height, 0]) : linearAxis(values, [height, 0]);
    const svg = frame(box, x, y, { x: across.label, y: heading(metric) + (metric.unit ? ` (${metric.unit})` : "") });
    if (shown) {
      svg.append("line").attr({ class: "floor", x1: 0, x2: width, y1: y.place(floor), y2: y.place(floor) });
      svg.append("text").attr({ x: 6, y: y.place(floor) - 5 }).text("estimated error of the reference");
    }
    scene.samplers.forEach((s, i) => curve(svg, s, i, across, x, y));
    if (isLog && zeros) {
      box.append("p").attr("class", "muted").text(
        `${zeros} of ${runs.length} renders have the value 0, which has no logarithm: they stand on the lower edge.`);
    }
  }

  function errorPlots(section, scene) {
    section.append("h3").text("Error against CPU time and samples");
    const note = section.append("p").attr("class", "muted");
    legend(section, scene);
    const grid = section.append("div").attr("class", "plots");
    const draw = () => {
      note.text("Median over seeds (line), 5–95 % (band), single renders (dots). " + (metric.lower_is_better
        ? "Both axes are logarithmic; lower left is better."
        : `For ${heading(metric)} higher is better: upper left. Time and samples are logarithmic.`));
      grid.html("");
      [cpuTime, samples].forEach((across) => errorPlot(grid, scene, across));
    };
    redraws.push(draw);
    draw();
  }

  // One line for each sampler's spectrum, divided by `scale(spectrum)`, and its white noise dashed.
  function spectrumPlot(parent, scene, spp, title, label, scale) {
    const box = parent.append("div").attr("class", "plot");
    box.append("h4").text(title);
    const lines = [];
    scene.samplers.forEach((s, i) => {
      const rung = s.rungs.find((r) => r.spp === spp);
      if (!rung || !rung.spectrum || !(rung.spectrum.white_noise > 0)) return;
      const by = scale(rung.spectrum);
      const points = rung.spectrum.power.map((power, k) => ({ x: scene.frequencies[k], y: power / by })).filter((p) => p.y > 0);
      lines.push({ sampler: s.sampler, index: i, points: points, white: rung.spectrum.white_noise / by });
    });
    const points = [].concat(...lines.map((line) => line.points));
    if (!points.length) {
      box.append("p").text("No error above zero was measured.");
      return;
    }
    const x = logAxis(scene.frequencies, 1.05, [0, width]);
    const y = logAxis(points.map((p) => p.y).concat(lines.map((line) => line.white)), 1.3, [height, 0]);
    const svg = frame(box, x, y, { x: "Spatial frequency (cycles per pixel)", y: label });
    const whites = new Map(lines.map((line) => [line.white, colour(line.index)]));
    whites.forEach((stroke, white) => svg.append("line")
      .attr({ class: "white", x1: 0, x2: width, y1: y.place(white), y2: y.place(white) })
      .style("stroke", whites.size < lines.length ? "var(--muted)" : stroke));
    lines.forEach((line) => {
      svg.append("path").attr("class", "median").style("stroke", colour(line.index))
        .attr("d", d3.svg.line().x((p) => x.place(p.x)).y((p) => y.place(p.y))(line.points))
        .append("title").text(line.sampler);
    });
  }

  function spectra(section, scene) {
    if (!scene.frequencies.length) return;
    section.append("h3").text("Spectrum of the error");
    const counts = Array.from(new Set([].concat(...scene.samplers.map((s) => s.rungs.map((r) => r.spp))))).sort((a, b) => b - a);
    const controls = section.append("div").attr("class", "controls");
    const select = controls.append("label").text("Samples per pixel ").append("select");
    select.selectAll("option").data(counts).enter().append("option").text((spp) => spp);
    legend(section, scene);
    const grid = section.append("div").attr("class", "plots");
    section.append("p").text(
      "Dashed: white noise of the same total power, which has as much at every frequency. A line above its dashed one " +
      "on the left is red error: power at low frequencies, blotches and bands many pixels wide. That is structure, and it " +
      "is seen, from afar too. A line below it on the left and above it on the right is blue error: fine grain, which the " +
      "eye blurs away. Of two samplers with the same RMSE, the redder one looks worse.");
    section.append("p").attr("class", "muted").text(
      "Power of the error of luminance over rings of frequencies, averaged over the seeds' images (not that of their mean); " +
      "both axes logarithmic.");
    const draw = () => {
      const spp = Number(select.property("value"));
      grid.html("");
      spectrumPlot(grid, scene, spp, "Power", "power (radiance²)", () => 1);
      spectrumPlot(grid, scene, spp, "Power relative to white noise", "power / white noise", (spectrum) => spectrum.white_noise);
    };
    select.on("change", draw);
    draw();
  }

  // Ratios: two decimals, or two digits where they are small.
  const ratio = (v) => (v >= 0.1 ? v.toFixed(2) : String(Number(v.toPrecision(2))));

  function cell(row, value, isBase) {
    const td = row.append("td").text(value ? number(value.median) : "–");
    if (!value) return;
    if (!value.ratio) {
      if (!isBase) td.append("small").text("no ratio");
      return;
    }
    const interval = value.ratio.interval_95;
    td.append("small").text(isBase ? "× 1" : `× ${ratio(value.ratio.value)}` +
      (interval ? ` [${ratio(interval[0])}, ${ratio(interval[1])}]` : ""));
  }

  function equalTime(section, scene) {
    section.append("h3").text("At equal CPU time");
    const budgets = scene.equal_time.budgets;
    if (!budgets.length) {
      section.append("p").attr("class", "note").text(
        "No CPU time is covered by every sampler, and nothing is extrapolated: there is no equal-time figure. " +
        "More or wider sample counts give one.");
      return;
    }
    section.append("p").attr("class", "muted").text(
      `Median error, read between the measured points (straight in both logarithms, never beyond them), and ratio to ` +
      `${scene.samplers[0].sampler}: geometric mean over seeds, 95 % interval (Student) over seeds.`);
    const table = section.append("div").attr("class", "table").append("table");
    const draw = () => {
      const columns = data.table.map((column) => data.metrics.find((m) => m.name === column.name));
      if (!columns.includes(metric)) columns.unshift(metric);
      table.html("");
      const head = table.append("thead").append("tr");
      head.append("th").text("Sampler");
      columns.forEach((m) => head.append("th").classed("chosen", m === metric).text(
        heading(m) + (m.unit ? ` (${m.unit})` : "") + (m.lower_is_better ? "" : ", higher is better")));
      const body = table.append("tbody");
      budgets.forEach((budget) => {
        body.append("tr").attr("class", "budget").append("td").attr("colspan", 1 + columns.length)
          .text(seconds(budget.cpu_seconds));
        budget.samplers.forEach((entry, i) => {
          const row = body.append("tr");
          const label = row.append("td");
          label.append("span").attr("class", "swatch").style("background", colour(i));
          label.append("span").text(entry.sampler);
          columns.forEach((m) => cell(row, entry[m.name], i === 0));
        });
      });
    };
    redraws.push(draw);
    draw();
  }

  // What the image selector offers: nearest measured render to each time, or equal sample counts.
  function imageChoices(scene) {
    const withImage = (s) => s.rungs.filter((r) => r.png);
    const nearest = (time) => (s) => {
      const distance = (r) => Math.abs(Math.log(r.cpu_seconds.median / time));
      return withImage(s).sort((a, b) => distance(a) - distance(b))[0];
    };
    const choices = scene.equal_time.budgets.map((b) => (
      { text: `renders nearest to ${seconds(b.cpu_seconds)} of CPU time`, time: b.cpu_seconds, pick: nearest(b.cpu_seconds) }));
    const counts = new Set([].concat(...scene.samplers.map((s) => withImage(s).map((r) => r.spp))));
    Array.from(counts).sort((a, b) => b - a).forEach((spp) => choices.push(
      { text: `${spp} samples per pixel`, pick: (s) => withImage(s).find((r) => r.spp === spp) }));
    return choices;
  }

  function figuresOf(scene, choice) {
    const figures = [{ title: "reference", file: scene.reference.png, lines: [scene.reference.spp ? `${scene.reference.spp} spp` : "given"] }];
    const weights = [];
    scene.samplers.forEach((s, i) => {
      const rung = choice.pick(s);
      if (!rung) return;
      const errors = rung.runs.find((r) => r.seed === 0);
      const share = choice.time ? `, ${ratio(errors.cpu_seconds / choice.time)} of the time named` : "";
      figures.push({ title: s.sampler, file: rung.png, colour: colour(i), lines: [
        `${rung.spp} spp, ${seconds(errors.cpu_seconds)} of CPU time${share}`,
        data.table.map((column) => `${column.heading} ${number(errors[column.name])}`).join(", ")] });
      if (rung.weights_png) weights.push({ title: `weights of ${s.sampler}`, file: rung.weights_png, lines: [
        `mean ${number(rung.mean_weight)}; black is 0, white is 1`] });
    });
    return figures.concat(weights);
  }

  function images(section, scene) {
    const choices = imageChoices(scene);
    if (!choices.length) return;
    section.append("h3").text("Images");
    section.append("p").attr("class", "muted").text(
      "First seed, all at one exposure. Click or drag on an image to move the enlarged crop in all of them.");
    const controls = section.append("div").attr("class", "controls");
    const select = controls.append("label").text("Show ").append("select");
    select.selectAll("option").data(choices).enter().append("option").attr("value", (d, i) => i).text((d) => d.text);
    const zoom = controls.append("label").text("Zoom ").append("input")
      .attr({ type: "range", min: 2, max: 16, step: 1, value: 6 });
    const grid = section.append("div").attr("class", "images");
    const [width, height] = scene.resolution;
    const centre = { x: 0.5, y: 0.5 };

    function moveCrops() {
      const z = Number(zoom.property("value"));
      grid.selectAll("figure").each(function (figure) {
        const crop = d3.select(this).select(".crop");
        const w = crop.node().clientWidth, h = crop.node().clientHeight;
        const left = Math.round(centre.x * width - w / z / 2), top = Math.round(centre.y * height - h / z / 2);
        crop.style({ "background-image": `url("${encodeURI(figure.file)}")`, "background-size": `${width * z}px ${height * z}px`,
          "background-position": `${-left * z}px ${-top * z}px` });
        d3.select(this).select(".marker").style({ left: `${100 * left / width}%`, top: `${100 * top / height}%`,
          width: `${100 * w / z / width}%`, height: `${100 * h / z / height}%` });
      });
    }
    function follow(event) {
      const box = event.currentTarget.getBoundingClientRect();
      centre.x = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
      centre.y = Math.min(1, Math.max(0, (event.clientY - box.top) / box.height));
      moveCrops();
    }
    function show() {
      const figures = figuresOf(scene, choices[Number(select.property("value"))]);
      grid.html("");
      const items = grid.selectAll("figure").data(figures).enter().append("figure");
      const whole = items.append("div").attr("class", "whole");
      whole.append("img").attr({ src: (d) => encodeURI(d.file), alt: (d) => d.title, width: width, height: height, draggable: "false" });
      whole.append("div").attr("class", "marker");
      whole.on("pointerdown", () => follow(d3.event));
      whole.on("pointermove", () => { if (d3.event.buttons) follow(d3.event); });
      items.append("div").attr("class", "crop");
      const caption = items.append("figcaption");
      caption.append("span").attr("class", "swatch").style("background", (d) => d.colour || "transparent")
        .style("display", (d) => (d.colour ? null : "none"));
      caption.append("b").text((d) => d.title);
      caption.selectAll("div").data((d) => d.lines).enter().append("div").attr("class", "muted").text((d) => d);
      moveCrops();
    }
    select.on("change", show);
    zoom.on("input", moveCrops);
    window.addEventListener("resize", moveCrops);
    show();
  }

  function notes(section, scene) {
    const list = [];
    scene.samplers.filter((s) => s.biased).forEach((s) => list.push(
      `${s.sampler} is biased: how it mixes pilot and main image depends, pixel by pixel, on the pilot itself.`));
    const unbiased = scene.samplers.filter((s) => !s.biased).map((s) => s.sampler);
    if (unbiased.length) list.push(`Unbiased: ${unbiased.join(", ")}.`);
    list.push("RMSE and relMSE compare pixel by pixel and do not see structure: a sequence that pixels share " +
      "makes errors alike in neighbouring pixels, which the eye finds before noise of the same size. FLIP, low-pass " +
      "RMSE and the spectrum see it, Yee's metric often does not. Look at the images too.");
    list.push(`Reference: ${scene.reference.origin}.` + (scene.reference.relmse_estimate === null
      ? " Its own error is not known." : ` Its own relMSE is about ${number(scene.reference.relmse_estimate)}, ` +
        "estimated from the two halves; it is part of every error above."));
    scene.samplers.forEach((s) => {
      const rung = s.rungs[s.rungs.length - 1];
      if (rung) list.push(`${s.sampler}: lanes ${rung.lanes} (pixels across, down, samples of each), ` +
        `${number(100 * rung.lanes_active)} % of them active` + (rung.pilot_spp ?
        `, pilot ${rung.pilot_spp} of ${rung.spp} samples, mean weight ${number(rung.mean_weight)}` : "") + ".");
      const bad = d3.sum(s.rungs, (r) => r.nonfinite);
      if (bad) list.push(`${s.sampler}: ${bad} samples were not finite and were left out.`);
    });
    list.push(`The scene uses: ${scene.features.join(", ") || "nothing special"}. Left out of its kernels: ` +
      `${scene.left_out.join(", ") || "nothing"}.`);
    scene.warnings.forEach((w) => list.push(`Scene file: ${w}`));
    section.append("h3").text("Notes");
    section.append("ul").selectAll("li").data(list).enter().append("li").text((d) => d);
  }

  function sceneSection(scene) {
    const section = page.append("section");
    section.append("h2").text(scene.scene);
    const facts = section.append("dl").attr("class", "facts");
    fact(facts, "Resolution", scene.resolution.join(" × "));
    fact(facts, "Depth", scene.depth === 1 ? "1 (direct light only)" : `${scene.depth} lit surfaces`);
    fact(facts, "Triangles", scene.triangles.toLocaleString("en"));
    fact(facts, "Packet width", `${scene.width} lanes`);
    fact(facts, "Threads", scene.threads);
    fact(facts, "Exposure in images", number(scene.exposure));
    const verdict = data.verdicts.find((v) => v.scene === scene.scene && v.depth === scene.depth);
    if (verdict) section.append("p").attr("class", "verdict").text(verdict.sentence);
    errorPlots(section, scene);
    spectra(section, scene);
    equalTime(section, scene);
    images(section, scene);
    notes(section, scene);
  }

  header();
  metricSelector();
  data.scenes.forEach(sceneSection);
  page.append("footer").html('All figures: <a href="summary.json">summary.json</a>, every render: ' +
    '<a href="errors.csv">errors.csv</a>, spectra: <a href="spectra.csv">spectra.csv</a>. Charts: D3.');
  document.title = "Lockstep: " + data.scenes.map((s) => s.label).join(", ");
})();
