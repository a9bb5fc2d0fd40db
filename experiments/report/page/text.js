// Numbers and small pieces of text.

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

// For a closer look: six digits, as a CSV file would write them.
const exact = (v) => (typeof v === "number" ? String(Number(v.toPrecision(6))) : "not finite");

// Ratios: two decimals, or two digits where they are small.
const ratio = (v) => (v >= 0.1 ? v.toFixed(2) : String(Number(v.toPrecision(2))));

const fileNameSafe = (text) => text.replace(/[^A-Za-z0-9.=-]+/g, "_");

// As a POSIX shell wants an argument.
const shellQuoted = (text) => (/^[\w./,:=+@%-]+$/.test(text) ? text : `'${text.replace(/'/g, "'\\''")}'`);

// A file made in the page, for the reader to keep.
function save(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function button(parent, label, title, act) {
  return parent.append("button").attr({ type: "button", title: title, "aria-label": title }).text(label).on("click", act);
}

function fact(list, term, text) {
  const box = list.append("div");
  box.append("dt").text(term);
  box.append("dd").text(text);
}
