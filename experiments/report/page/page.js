// The page from top to bottom.

function header() {
  const labels = summary.scenes.map((s) => s.label).join(", ");
  document.title = `Lockstep: ${labels}`;
  page.append("h1").text(`Error at equal time: ${labels}`);
  page.append("p").attr("class", "muted").text(
    "How far each sampler's images are from a reference, against the CPU time that the images took. " +
    `${summary.machine.cpu}; ${summary.seeds} seeds; ${summary.date}.`);
  if (!summary.complete) {
    page.append("p").attr("class", "note").text("Stopped before all seeds were rendered: what follows was measured until then.");
  }
  if (summary.verdicts.length) {
    page.append("ul").attr("class", "verdicts").selectAll("li").data(summary.verdicts).enter().append("li").text((v) => v.sentence);
  }
}

function contents() {
  const list = page.append("nav").attr("aria-label", "Contents");
  summary.scenes.forEach((scene, k) => list.append("a").attr("href", `#scene-${k}`).text(scene.label));
  list.append("a").attr("href", "#settings").text("settings and commands");
}

function sceneSection(scene, k) {
  const section = page.append("section").attr("id", `scene-${k}`);
  section.append("h2").text(scene.scene);
  const facts = section.append("dl").attr("class", "facts");
  fact(facts, "Resolution", scene.resolution.join(" × "));
  fact(facts, "Depth", scene.depth === 1 ? "1 (direct light only)" : `${scene.depth} lit surfaces`);
  fact(facts, "Triangles", scene.triangles.toLocaleString("en"));
  fact(facts, "Packet width", `${scene.width} lanes`);
  fact(facts, "Threads", scene.threads);
  fact(facts, "Exposure in images", number(scene.exposure));
  if (scene.unlike_machines) section.append("p").attr("class", "note").text(scene.unlike_machines);
  errorPlots(section, scene);
  if (imageIndex[k]) imageViewer(section, scene, imageIndex[k]);
  spectrumPlots(section, scene);
  equalTime(section, scene);
  timeToError(section, scene);
  notes(section, scene);
}

function footer() {
  const line = page.append("footer");
  line.append("span").text("Beside this page, for scripts: ");
  [["summary.json", "all figures"], ["errors.csv", "every render"], ["spectra.csv", "spectra"], ["figures/", "plots for a paper"]]
    .forEach(([file, what]) => { line.append("a").attr("href", file).text(file); line.append("span").text(` (${what}) `); });
  line.append("span").text("Charts: D3.");
}

defineColours();
header();
selectionBar();
overview();
contents();
summary.scenes.forEach(sceneSection);
settings();
footer();

// Plots are drawn for the window's width.
let drawnWidth = window.innerWidth;
window.addEventListener("resize", () => {
  if (window.innerWidth === drawnWidth) return;
  drawnWidth = window.innerWidth;
  redrawAll();
});
document.documentElement.dataset.ready = "yes";
