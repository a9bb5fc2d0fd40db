// What stands below an image in the viewer: values of a pixel, the scale of a map, the caption.

// Values of a pixel of a decoded method, or a hint where there is none.
function drawValues(readout, scene, index, method, of, pixel) {
  readout.html("");
  if (!pixel) return void readout.text("Point at a pixel for its values.");
  const i = pixel.y * index.size[0] + pixel.x;
  const rgb = (halves) => [0, 1, 2].map((c) => number(floatOfHalf[halves[3 * i + c]] / scene.exposure)).join("  ");
  const add = (name, text) => {
    const part = readout.append("span");
    part.append("b").text(name);
    part.append("span").text(` ${text}`);
  };
  add("pixel", `${pixel.x * index.factor}, ${pixel.y * index.factor}`);
  add(method.name, rgb(of.radiance));
  if (!of.reference) return;
  add("reference", rgb(of.reference));
  const error = luminance(of.radiance, 3 * i) - luminance(of.reference, 3 * i);
  add("luminance error", `${error > 0 ? "+" : ""}${number(error / scene.exposure)}`);
  if (of.flip) add("FLIP", (of.flip[i] / 255).toFixed(3));
  if (of.weights) add("weight", (of.weights[i] / 255).toFixed(3));
}

// The colours of an error map and the values at their ends.
function drawScale(bar, scene, state) {
  const view = state.view;
  bar.html("").style("display", view.scale ? null : "none");
  if (!view.scale) return;
  // The largest value that is told apart, in units of the map.
  const end = view.scale === "fixed" ? 1 : 1 / (Math.pow(2, state.stops[view.stops]) * (view.scale === "share" ? 1 : scene.exposure));
  const both = view.ends === "both";
  const colourAt = (t) => (view.grey ? [255 * t, 255 * t, 255 * t] : both ? signedColour(2 * t - 1) : magmaColour(t));
  const ramp = d3.range(17).map((k) => `rgb(${colourAt(k / 16).map(Math.round).join()})`);
  bar.append("span").text(both ? `−${number(end)}` : "0");
  bar.append("span").attr("class", "ramp").style("background", `linear-gradient(to right, ${ramp.join()})`);
  bar.append("span").text(number(end));
  bar.append("span").attr("class", "muted").text({ luminance: "difference of luminance, brighter than the reference in orange",
    radiance: "absolute difference, mean of RGB", share: "absolute difference over the reference's luminance + 0.01 of white",
    fixed: view.grey ? "weight of each pixel: 0 shares all, 1 is independent" : "LDR-FLIP as in errors.csv" }[view.scale]);
}

function drawCaption(caption, state) {
  const method = state.methods[state.at], view = state.view;
  caption.html("");
  caption.append("b").text(method.name);
  const lacks = (view.name === "weights" && !method.ids.weights) || (view.scale && method.reference);
  const lines = lacks ? [`no ${view.title.toLowerCase()} of this one: its image is shown`, ...method.lines] : method.lines;
  caption.selectAll("div").data(lines).enter().append("div").attr("class", "muted").text((d) => d);
  if (method.command) caption.append("code").text(method.command);
}
