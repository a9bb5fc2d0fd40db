// Errors at equal CPU time, in figures.

// A median with its ratio to the first sampler and the ratio's interval.
function errorCell(row, value, isBase, isBest) {
  const td = row.append("td").classed("best", isBest);
  td.append("span").text(value ? number(value.median) : "–");
  if (!value) return;
  if (!value.ratio) {
    if (!isBase) td.append("small").text("no ratio");
    return;
  }
  const interval = value.ratio.interval_95;
  td.append("small").text(isBase ? "× 1" : `× ${ratio(value.ratio.value)}` +
    (interval ? ` [${ratio(interval[0])}, ${ratio(interval[1])}]` : ""));
  if (value.ratio.medians_disagree) {
    td.append("abbr").text("†").attr("title", `The medians' ratio is ${ratio(value.ratio.of_medians)}: few pixels or ` +
      "seeds decide. relMSE, trimmed, leaves the worst pixels out.");
  }
}

function samplerCell(row, i, name) {
  const cell = row.append("th").attr("scope", "row");
  sample(cell, i);
  cell.append("span").text(name);
}

// The metrics in columns: the table's, and the chosen one where it is none of them.
function tableColumns() {
  const columns = summary.table.map((column) => summary.metrics.find((m) => m.name === column.name));
  return columns.includes(selection.metric) ? columns : [selection.metric, ...columns];
}

function columnHeads(table, first, texts, chosen) {
  const head = table.append("thead").append("tr");
  head.append("th").attr("scope", "col").text(first);
  texts.forEach((text, k) => head.append("th").attr("scope", "col").classed("chosen", k === chosen).text(text));
}

// Which of a budget's samplers has the best median of a metric.
function bestOf(entries, metric) {
  const better = (a, b) => (metric.lower_is_better ? a < b : a > b);
  let best = null;
  entries.forEach((entry) => {
    const value = entry[metric.name];
    if (value && (!best || better(value.median, best[metric.name].median))) best = entry;
  });
  return best;
}

function budgetRows(body, budget, columns) {
  const entries = budget.samplers.map((entry, i) => ({ entry, i })).filter((e) => shown(e.i));
  const best = columns.map((m) => bestOf(entries.map((e) => e.entry), m));
  entries.forEach(({ entry, i }) => {
    const row = body.append("tr");
    samplerCell(row, i, entry.sampler);
    columns.forEach((m, k) => errorCell(row, entry[m.name], i === 0, entry === best[k]));
  });
}

function metricHeads(table, columns) {
  columnHeads(table, "Sampler", columns.map((m) => withUnit(m) + (m.lower_is_better ? "" : ", higher is better")),
    columns.indexOf(selection.metric));
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
    `${scene.samplers[0].sampler}: geometric mean over seeds, with its 95 % interval over seeds; † where the medians' ` +
    `own ratio lies far outside it. Best medians are bold.`);
  const table = section.append("div").attr("class", "table").append("table");
  drawNowAndLater(() => {
    const columns = tableColumns();
    table.html("");
    metricHeads(table, columns);
    const body = table.append("tbody");
    budgets.forEach((budget) => {
      body.append("tr").attr("class", "budget").append("td").attr("colspan", 1 + columns.length).text(seconds(budget.cpu_seconds));
      budgetRows(body, budget, columns);
    });
  });
}

// CPU time that each sampler needs to reach an error, and its ratio to the first one's.
function timeToError(section, scene) {
  const targets = scene.time_to_error || [];
  if (!targets.length) return;
  section.append("h3").text("CPU time to reach an error");
  section.append("p").attr("class", "muted").text(
    `Read between the measured points of the median errors, and ratio to ${scene.samplers[0].sampler} with its 95 % interval.`);
  const table = section.append("div").attr("class", "table").append("table");
  drawNowAndLater(() => {
    table.html("");
    columnHeads(table, "Sampler", targets.map((t) => `${heading(summary.metrics.find((m) => m.name === t.metric))} ${number(t.error)}`), -1);
    const body = table.append("tbody");
    samplerNames.forEach((name, i) => {
      if (!shown(i)) return;
      const row = body.append("tr");
      samplerCell(row, i, name);
      targets.forEach(({ samplers }) => {
        const seconds = samplers[i].cpu_seconds, fastest = d3.min(samplers, (s) => s.cpu_seconds || Infinity);
        errorCell(row, seconds && { median: seconds, ratio: samplers[i].ratio }, i === 0, seconds === fastest);
      });
    });
  });
}

// The longest time that was measured for every sampler.
const longestBudget = (scene) => scene.equal_time.budgets
  .filter((budget) => budget.samplers.every((entry) => entry[summary.metrics[0].name]))
  .reduce((longest, budget) => (!longest || budget.cpu_seconds > longest.cpu_seconds ? budget : longest), null);

// Of several scenes: the chosen metric, a column for each, and the geometric mean of the ratios.
function scenesTable(table, scenes) {
  const metric = selection.metric;
  columnHeads(table, "Sampler", [...scenes.map((s) => `${s.label}, ${seconds(longestBudget(s).cpu_seconds)}`), "Mean ratio"], -1);
  const body = table.append("tbody");
  const best = scenes.map((scene) => bestOf(longestBudget(scene).samplers.filter((_, i) => shown(i)), metric));
  samplerNames.forEach((name, i) => {
    if (!shown(i)) return;
    const row = body.append("tr");
    samplerCell(row, i, name);
    const entries = scenes.map((scene) => longestBudget(scene).samplers[i]);
    entries.forEach((entry, k) => errorCell(row, entry[metric.name], i === 0, entry === best[k]));
    const ratios = entries.map((entry) => entry[metric.name] && entry[metric.name].ratio).filter((r) => r && r.value > 0);
    row.append("td").text(ratios.length === scenes.length
      ? `× ${ratio(Math.exp(d3.mean(ratios, (r) => Math.log(r.value))))}` : "–");
  });
}

// What came out, before everything else: at the longest time that all samplers have in common.
function overview() {
  const scenes = summary.scenes.filter(longestBudget);
  if (!scenes.length) return;
  const several = scenes.length > 1;
  const caption = page.append("p").attr("class", "muted");
  const table = page.append("div").attr("class", "table").append("table");
  drawNowAndLater(() => {
    caption.text(several
      ? `${heading(selection.metric)} at the longest CPU time that all samplers have in common, with the ratio to ` +
        `${samplerNames[0]} and its 95 % interval; last the geometric mean of the ratios over scenes.`
      : `At ${seconds(longestBudget(scenes[0]).cpu_seconds)} of CPU time: median errors, ratio to ${samplerNames[0]} and its ` +
        "95 % interval.");
    table.html("");
    if (several) return scenesTable(table, scenes);
    metricHeads(table, tableColumns());
    return budgetRows(table.append("tbody"), longestBudget(scenes[0]), tableColumns());
  });
}
