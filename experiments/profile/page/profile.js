"use strict";
(function () {
  const data = JSON.parse(document.getElementById("data").textContent);
  const page = d3.select("#profile");
  const colours = d3.range(7).map((i) => "var(--c" + i + ")");
  const kinds = ["camera", "bounce", "shadow"];
  const number = (digits) => (v) => (v === null || !isFinite(v) ? "–" : v.toPrecision(digits));
  const ratio = (v) => (v === null || !isFinite(v) ? "–" : v.toFixed(2) + " ×");
  const rate = (v) => (1e-6 * v).toFixed(2);

  const pointOf = (weight, lanes) => data.points.find((p) => p.weight === weight && p.lanes === lanes);
  const errorsOf = (weight) => data.errors.find((e) => e.weight === weight);
  const base = pointOf(data.base.weight, data.base.lanes);

  function section(title, text) {
    const s = page.append("section");
    s.append("h2").text(title);
    if (text) s.append("p").attr("class", "muted").text(text);
    return s;
  }

  // rows: arrays of cells; marked: the index of the row that others are compared with.
  function table(parent, heads, rows, marked) {
    const t = parent.append("div").attr("class", "table").append("table");
    t.append("tr").selectAll("th").data(heads).enter().append("th").text((h) => h);
    rows.forEach((cells, i) => {
      const row = t.append("tr").attr("class", i === marked ? "base" : null);
      cells.forEach((c) => row.append("td").text(c));
    });
  }

  function head() {
    page.append("h1").text("Coherence of " + data.scene);
    page.append("p").text(
      "Sampler " + data.sampler + ", " + data.spp + " samples per pixel, depth " + data.depth + ", " + data.isa +
      ", packets of " + data.width + " lanes in kernels. Speeds are rays or paths per second of CPU time of one " +
      "thread, medians of " + data.repeats + " repeats.");
    page.append("p").text(
      "Weight 0: all pixels share their random numbers; weight 1: they are independent. c and t: a map of weights " +
      "from a pilot.");
    if (data.no_counters) page.append("p").attr("class", "note").text(data.no_counters);
  }

  // What coherence gains, against the base: speed first, then error.
  function gains() {
    const shown = ["flip_ldr", "flip_hdr", "yee_pixels", "relmse", "low_pass_rmse"]
      .map((name) => data.metrics.find((m) => m.name === name)).filter((m) => m);
    const s = section("Gain",
      "Against weight " + data.base.weight + ", each weight in its fastest layout of lanes. Speed: above 1 is faster. " +
      "Errors: below 1 is better, the mean of " + data.seeds + " renders against " + data.reference_spp +
      " samples per pixel; a few per cent may be noise.");
    const marked = data.weights.findIndex((w) => w.weight === data.base.weight);
    table(s, ["weight", "lanes", "mean w", "Mpaths/s", "speed"], data.weights.map((w) => {
      const p = pointOf(w.weight, w.lanes);
      return [w.weight, w.lanes, number(3)(p.mean_weight), rate(p.paths_per_second),
        ratio(p.paths_per_second / base.paths_per_second)];
    }), marked);
    if (!data.errors.length) return;
    [["equal samples", "equal_samples"], ["equal time", "equal_time"]].forEach(([title, at]) => {
      const own = errorsOf(data.base.weight)[at].values;
      s.append("h4").text("Error at " + title);
      table(s, ["weight", "samples"].concat(shown.map((m) => m.name)), data.errors.map((e) =>
        [e.weight, e[at].spp].concat(shown.map((m) => ratio(e[at].values[m.name] / own[m.name])))), marked);
    });
  }

  // One chart: lines of y over the weights in their order.
  function chart(parent, title, weights, lines) {
    const width = 420, height = 230, left = 46, right = 12, top = 10, bottom = 34;
    const plot = parent.append("div").attr("class", "plot");
    plot.append("h4").text(title);
    const svg = plot.append("svg").attr("viewBox", "0 0 " + width + " " + height);
    const x = d3.scale.ordinal().domain(weights).rangePoints([left, width - right], 0.4);
    const most = d3.max(lines, (l) => d3.max(l.values, (v) => v.y)) || 1;
    const y = d3.scale.linear().domain([0, 1.05 * most]).range([height - bottom, top]);
    svg.append("rect").attr({ class: "frame", x: left, y: top, width: width - left - right, height: height - top - bottom });
    y.ticks(5).forEach((t) => {
      svg.append("line").attr({ class: "grid", x1: left, x2: width - right, y1: y(t), y2: y(t) });
      svg.append("text").attr({ x: left - 6, y: y(t) + 4, "text-anchor": "end" }).text(t);
    });
    weights.forEach((w) => svg.append("text").attr({ x: x(w), y: height - bottom + 18, "text-anchor": "middle" })
      .style("font-size", weights.length > 6 ? "9.5px" : null).text(w));
    const path = d3.svg.line().x((v) => x(v.x)).y((v) => y(v.y));
    lines.forEach((l) => {
      svg.append("path").attr({ class: "line", d: path(l.values) }).style("stroke", l.colour);
      svg.selectAll(null).data(l.values).enter().append("circle")
        .attr({ cx: (v) => x(v.x), cy: (v) => y(v.y), r: 3 }).style("fill", l.colour)
        .append("title").text((v) => l.name + ": " + number(4)(v.y));
    });
  }

  function legend(parent, entries) {
    const l = parent.append("div").attr("class", "legend").selectAll("span").data(entries).enter().append("span");
    l.append("i").attr("class", "swatch").style("background", (e) => e.colour);
    l.append("span").text((e) => e.name);
  }

  const weights = data.weights.map((w) => w.weight);
  const layouts = d3.set(data.points.map((p) => p.lanes)).values();
  const classes = [];
  data.points.forEach((p) => p.classes.forEach((c) => {
    if (!classes.some((k) => k.kind === c.kind && k.bounce === c.bounce)) classes.push({ kind: c.kind, bounce: c.bounce });
  }));
  classes.sort((a, b) => a.bounce - b.bounce || kinds.indexOf(a.kind) - kinds.indexOf(b.kind));
  const classOf = (p, k) => p.classes.find((c) => c.kind === k.kind && c.bounce === k.bounce);

  // A choice of layout, and what is drawn for it.
  function byLayout(parent, draw) {
    const label = parent.append("p").text("Lanes (pixels × pixels × samples): ");
    const select = label.append("select").attr("aria-label", "lanes");
    select.selectAll("option").data(layouts).enter().append("option").text((l) => l);
    select.property("value", data.base.lanes);
    const body = parent.append("div");
    const redraw = () => { body.selectAll("*").remove(); draw(body, select.property("value")); };
    select.on("change", redraw);
    redraw();
  }

  function speeds() {
    const s = section("Rays per CPU second by traversal mode",
      "The same rays traced in every mode, in millions per second; auto is the renderer's policy.");
    byLayout(s, (body, lanes) => {
      const modes = d3.keys(base.classes[0].modes).filter((m) => /^(single|packet8.*|packet16.*|stream1m|auto)$/.test(m));
      const entries = modes.map((m, i) => ({ name: m, colour: colours[i % 7] }));
      legend(body, entries);
      const plots = body.append("div").attr("class", "plots");
      classes.slice(0, 9).forEach((k) => chart(plots, k.kind + " rays, bounce " + k.bounce, weights, entries.map((e) => ({
        name: e.name, colour: e.colour,
        values: weights.map((w) => ({ x: w, c: classOf(pointOf(w, lanes), k) })).filter((v) => v.c && v.c.modes[e.name])
          .map((v) => ({ x: v.x, y: 1e-6 * v.c.modes[e.name] }))
      }))));
    });
  }

  function coherence() {
    const s = section("Packets",
      "Means over packets of " + data.packet_lanes + " rays that follow each other: share of lanes with a ray, spread " +
      "of directions (0: parallel, 1: all ways), different triangles and materials that are hit. Best: the fastest " +
      "fixed mode; policy: what the renderer chose.");
    byLayout(s, (body, lanes) => {
      const rows = [];
      classes.forEach((k) => weights.forEach((w) => {
        const c = classOf(pointOf(w, lanes), k);
        if (!c) return;
        const shadow = k.kind === "shadow";
        rows.push([k.kind + " " + k.bounce, w, c.rays, (100 * c.lanes_active).toFixed(0) + " %", number(3)(c.spread),
          shadow ? "–" : c.triangles.toFixed(1), shadow ? "–" : c.materials.toFixed(1), rate(c.modes.single),
          rate(c.modes[c.best]), c.best, rate(c.modes.auto), c.policy]);
      }));
      table(body, ["rays, bounce", "weight", "rays", "lanes active", "spread", "triangles", "materials", "single, M/s",
        "best, M/s", "best mode", "auto, M/s", "policy's mode"], rows, -1);
    });
  }

  function stages() {
    const s = section("Whole renders", "Nanoseconds of CPU time per path by stage; counters are of the whole render.");
    const heads = ["weight", "lanes", "Mpaths/s", "sampling", "traversal", "shading", "film", "lanes active",
      "policy / best", "packets / single"];
    const counted = data.points.some((p) => p.counters);
    if (counted) heads.push("cycles per path", "instructions per path", "instructions per cycle", "cache misses per path");
    const rows = data.points.map((p) => {
      const all = d3.sum(d3.values(p.stages));
      const perPath = (v) => (1e9 * v / all / p.paths_per_second).toFixed(0);
      const cells = [p.weight, p.lanes, rate(p.paths_per_second)].concat(
        ["sampling", "traversal", "shading", "film"].map((k) => perPath(p.stages[k])),
        [(100 * p.lanes_active).toFixed(0) + " %", (100 * p.policy_share).toFixed(0) + " %", ratio(p.gain_over_single)]);
      const c = p.counters;
      if (counted) cells.push(...(c ? [c.cycles_per_path.toFixed(0), c.instructions_per_path.toFixed(0),
        number(3)(c.instructions_per_cycle), number(3)(c.cache_misses_per_path)] : ["–", "–", "–", "–"]));
      return cells;
    });
    table(s, heads, rows, data.points.indexOf(base));
  }

  function errors() {
    if (!data.errors.length) return;
    const s = section("Errors", "All metrics; lower is better, but for SSIM.");
    const rows = [];
    data.errors.forEach((e) => [["equal samples", e.equal_samples], ["equal time", e.equal_time]].forEach((at) =>
      rows.push([e.weight, at[0], at[1].spp, number(3)(at[1].cpu_seconds)].concat(
        data.metrics.map((m) => number(4)(at[1].values[m.name]))))));
    table(s, ["weight", "at", "samples", "CPU seconds"].concat(data.metrics.map((m) => m.name)), rows, -1);
  }

  head();
  gains();
  speeds();
  coherence();
  stages();
  errors();
})();
