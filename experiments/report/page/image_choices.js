// Which renders the viewer can show together.

// Where the page keeps the images of a scene's sampler at a sample count.
const embedded = (index, sampler, spp) => index.runs.find((run) => run.sampler === sampler && run.spp === spp);

// Nearest render to each time that the samplers have in common, then equal sample counts; those that the
// page has no image of are left out. pick(sampler, place) gives a rung.
function imageChoices(scene, index) {
  const withImage = (s, i) => s.rungs.filter((r) => embedded(index, i, r.spp));
  const nearest = (time) => (s, i) => {
    const distance = (r) => Math.abs(Math.log(r.cpu_seconds.median / time));
    return withImage(s, i).sort((a, b) => distance(a) - distance(b))[0];
  };
  const choices = scene.equal_time.budgets.map((b) => (
    { text: `renders nearest to ${seconds(b.cpu_seconds)} of CPU time`, time: b.cpu_seconds, pick: nearest(b.cpu_seconds) }));
  const counts = new Set(index.runs.map((run) => run.spp));
  Array.from(counts).sort((a, b) => b - a).forEach((spp) => choices.push(
    { text: `${spp} samples per pixel`, pick: (s, i) => withImage(s, i).find((r) => r.spp === spp) }));
  choices.forEach((choice) => {
    const here = scene.samplers.filter((s, i) => choice.pick(s, i)).length;
    if (here < scene.samplers.length) choice.text += ` (${here} of ${scene.samplers.length} samplers in this page)`;
  });
  return choices;
}

// What the viewer's tabs are for a choice: the reference, then each sampler that has an image.
function methodsOf(scene, index, choice) {
  const reference = { name: "reference", reference: true, ids: { radiance: index.reference },
    lines: [scene.reference.origin] };
  const methods = [reference];
  scene.samplers.forEach((s, i) => {
    const rung = choice.pick(s, i);
    if (!rung) return;
    const run = rung.runs.find((r) => r.seed === 0) || rung.runs[0];
    const share = choice.time ? `, ${ratio(run.cpu_seconds / choice.time)} of the time named` : "";
    const entry = embedded(index, i, rung.spp);
    methods.push({ name: s.sampler, series: i, ids: { radiance: entry.radiance, flip: entry.flip, weights: entry.weights },
      lines: [`${rung.spp} spp, ${seconds(run.cpu_seconds)} of CPU time${share}`,
        summary.table.map((column) => `${column.heading} ${number(run[column.name])}`).join(", ") +
          (rung.weights_png ? `; mean weight ${number(rung.mean_weight)}` : "")],
      command: renderCommand(scene, s.sampler, rung.spp) });
  });
  return methods;
}

const renderCommand = (scene, sampler, spp) => `${scene.render_command} --sampler ${shellQuoted(sampler)} --spp ${spp} --seed 0 ` +
  `-o ${fileNameSafe(`${scene.label}-${sampler}-${spp}spp`)}.exr`;

// All that views need to know of a method, decoded.
async function decodedMethod(method, index) {
  const [radiance, reference, flip, weights] = await Promise.all([
    radianceOf(method.ids.radiance, method.reference ? null : index.reference),
    method.reference ? null : radianceOf(index.reference, null),
    method.ids.flip ? mapOf(method.ids.flip) : null,
    method.ids.weights ? mapOf(method.ids.weights) : null]);
  return { radiance, reference, flip, weights };
}
