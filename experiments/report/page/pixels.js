// The page's images as numbers: decoding, and what a display shows of them.

// Values of all half floats by their bits.
const floatOfHalf = new Float32Array(65536);
for (let bits = 0; bits < 65536; ++bits) {
  const exponent = (bits >> 10) & 31, fraction = bits & 1023;
  const magnitude = exponent === 0 ? fraction * Math.pow(2, -24) : (1024 + fraction) * Math.pow(2, exponent - 25);
  floatOfHalf[bits] = bits & 0x8000 ? -magnitude : magnitude;
}

// Bytes of the zlib stream that an element of the page holds as base64.
async function unzipped(id) {
  const text = atob(document.getElementById(id).textContent);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Each image is decoded once.
const decoded = new Map();
function once(id, make) {
  if (!decoded.has(id)) decoded.set(id, make());
  return decoded.get(id);
}

// Half floats of an image's RGB values times the scene's exposure. Images other than the reference
// are kept as differences from it.
const radianceOf = (id, reference) => once(id, async () => {
  const planes = await unzipped(id);
  const prediction = reference ? await radianceOf(reference) : null;
  const count = planes.length / 2, halves = new Uint16Array(count);
  for (let i = 0; i < count; ++i) {
    const code = planes[i] | (planes[count + i] << 8);
    const difference = (code >> 1) ^ -(code & 1);
    halves[i] = difference + (prediction ? prediction[i] : i >= 3 ? halves[i - 3] : 0);
  }
  return halves;
});

// A map's bytes, 255 for 1.
const mapOf = (id) => once(id, async () => {
  const bytes = await unzipped(id);
  for (let i = 1; i < bytes.length; ++i) bytes[i] += bytes[i - 1];
  return bytes;
});

// The 8-bit sRGB code of every half float times `factor`.
function displayCodes(factor) {
  const codes = new Uint8ClampedArray(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const v = Math.min(1, floatOfHalf[bits] * factor);
    codes[bits] = v <= 0.0031308 ? 255 * 12.92 * v : 255 * (1.055 * Math.pow(v, 1 / 2.4) - 0.055);
  }
  return codes;
}

const luminance = (halves, i) => 0.2126 * floatOfHalf[halves[i]] + 0.7152 * floatOfHalf[halves[i + 1]] +
  0.0722 * floatOfHalf[halves[i + 2]];

// Mean over RGB of the absolute difference; values are radiance times the exposure.
const absoluteError = (a, b, i) => (Math.abs(floatOfHalf[a[i]] - floatOfHalf[b[i]]) +
  Math.abs(floatOfHalf[a[i + 1]] - floatOfHalf[b[i + 1]]) + Math.abs(floatOfHalf[a[i + 2]] - floatOfHalf[b[i + 2]])) / 3;

// Colours of -1 to 1: blue for less, black for the same, orange for more.
function signedColour(v) {
  const m = Math.min(1, Math.abs(v));
  return v < 0 ? [80 * m, 170 * m, 255 * m] : [255 * m, 150 * m, 40 * m];
}
// Colours of 0 to 1.
function magmaColour(v) {
  const k = 3 * Math.round(255 * Math.min(1, Math.max(0, v)));
  return [magma[k], magma[k + 1], magma[k + 2]];
}

// RGBA of `count` pixels.
function coloured(count, colourOf) {
  const rgba = new Uint8ClampedArray(4 * count);
  for (let i = 0; i < count; ++i) {
    const [r, g, b] = colourOf(i);
    rgba[4 * i] = r; rgba[4 * i + 1] = g; rgba[4 * i + 2] = b; rgba[4 * i + 3] = 255;
  }
  return rgba;
}

// The ways to look at a method's image. `stops` names the brightness that the reader sets, of images or of
// kinds of maps; `gain` is 2 to its power, and `of` has the method's and the reference's radiance and the
// method's maps. Null where there is nothing to show.
const views = [
  { name: "image", title: "Image", stops: "image", paint: (of, gain) => {
    const codes = displayCodes(gain);
    return coloured(of.radiance.length / 3, (i) => [codes[of.radiance[3 * i]], codes[of.radiance[3 * i + 1]], codes[of.radiance[3 * i + 2]]]);
  } },
  { name: "signed", title: "Signed error", stops: "error", scale: "luminance", ends: "both", paint: (of, gain) => of.reference &&
    coloured(of.radiance.length / 3, (i) => signedColour(gain * (luminance(of.radiance, 3 * i) - luminance(of.reference, 3 * i)))) },
  { name: "absolute", title: "Absolute error", stops: "error", scale: "radiance", paint: (of, gain) => of.reference &&
    coloured(of.radiance.length / 3, (i) => magmaColour(gain * absoluteError(of.radiance, of.reference, 3 * i))) },
  { name: "relative", title: "Relative error", stops: "relative", scale: "share", paint: (of, gain) => of.reference &&
    coloured(of.radiance.length / 3, (i) => magmaColour(gain * absoluteError(of.radiance, of.reference, 3 * i) /
      (Math.abs(luminance(of.reference, 3 * i)) + 0.01))) },
  { name: "flip", title: "FLIP", scale: "fixed", paint: (of) => of.flip && coloured(of.flip.length, (i) => magmaColour(of.flip[i] / 255)) },
  { name: "weights", title: "Weights", scale: "fixed", grey: true, paint: (of) => of.weights &&
    coloured(of.weights.length, (i) => [of.weights[i], of.weights[i], of.weights[i]]) },
];

// Stops for maps of errors of these methods, one scale for all: what only one pixel in fifty is above
// shows in full.
function errorStops(methods) {
  const errors = [];
  methods.forEach(({ radiance, reference }) => {
    const step = 3 * Math.max(1, Math.floor(radiance.length / 3 / 4000));
    for (let i = 0; i + 2 < radiance.length; i += step) errors.push(absoluteError(radiance, reference, i));
  });
  const large = d3.quantile(errors.sort((a, b) => a - b), 0.98);
  return large > 0 ? Math.round(-2 * Math.log2(large)) / 2 : 0;
}
