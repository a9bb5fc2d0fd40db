// What to know about the figures: notes on each scene, settings, versions and commands.

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

// Text that is meant for a terminal, with a button that copies it.
function terminalText(parent, label, text) {
  const head = parent.append("div").attr("class", "plot-bar");
  head.append("h4").text(label);
  const pre = parent.append("pre").attr("tabindex", 0).text(text);
  button(head.append("div").attr("class", "tools"), "Copy", `Copy: ${label}`, async function () {
    try {
      await navigator.clipboard.writeText(text);
    } catch (error) {  // not every browser lets a local file use the clipboard: the reader can copy it
      getSelection().selectAllChildren(pre.node());
    }
  });
}

function settings() {
  const section = page.append("section").attr("id", "settings");
  section.append("h2").text("Settings, machine and commands");
  const facts = section.append("dl").attr("class", "facts");
  fact(facts, "Machine", `${summary.machine.cpu}, ${summary.machine.processors} logical processors`);
  fact(facts, "System", summary.system);
  fact(facts, "Kernels", summary.isa);
  fact(facts, "Lockstep", summary.lockstep);
  Object.keys(summary.versions).forEach((name) => fact(facts, name, summary.versions[name]));
  fact(facts, "Date", summary.date);
  fact(facts, "Seeds", summary.seeds);
  fact(facts, "Samples per pixel", summary.spp.join(", "));
  Object.keys(summary.overrides || {}).forEach((name) => fact(facts, name.replace("_", " "), summary.overrides[name]));
  section.append("p").text(
    "Time is CPU time, summed over threads, of a complete render: pilot image, its filter and the weights are " +
    "included, loading the scene is not. Every point is a render of its own; samplers took turns, so that a " +
    "disturbance of the machine falls on all alike.");
  if (summary.command) terminalText(section, "This comparison", summary.command);
  if (summary.experiment) terminalText(section, "The same as a file for lockstep compare", summary.experiment);
  const spp = summary.spp[summary.spp.length - 1];
  terminalText(section, `Single images, here the first seed's at ${spp} samples per pixel`, [].concat(...summary.scenes.map((scene) =>
    scene.samplers.map((s) => renderCommand(scene, s.sampler, spp)))).join("\n"));
}
