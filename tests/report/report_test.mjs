// Looks at a report page as a reader would. Usage: report_test.mjs CHROMIUM FOLDER
import assert from "node:assert/strict";
import { readFileSync, statSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [executable, folder] = process.argv.slice(2);
const address = pathToFileURL(`${folder}/report.html`).href;
const summary = JSON.parse(readFileSync(`${folder}/summary.json`, "utf8"));
const samplers = summary.scenes[0].samplers.map((s) => s.sampler);

// Rows of errors.csv as objects of text.
function errorRows() {
  const fields = (line) => [...line.matchAll(/("(?:[^"]|"")*"|[^,]*)(?:,|$)/g)]
    .map((m) => (m[1].startsWith('"') ? m[1].slice(1, -1).replaceAll('""', '"') : m[1]));
  const [head, ...lines] = readFileSync(`${folder}/errors.csv`, "utf8").trim().split("\n");
  const names = head.split(",");
  return lines.map((line) => Object.fromEntries(fields(line).slice(0, names.length).map((v, i) => [names[i], v])));
}

// A page in a window of its own; what goes wrong in it ends the test.
async function open(browser, options) {
  const context = await browser.newContext(options);
  await context.setOffline(true);
  const page = await context.newPage();
  page.setDefaultTimeout(60000);
  page.problems = [];
  page.on("pageerror", (error) => page.problems.push(error.message));
  page.on("console", (message) => { if (message.type() === "error") page.problems.push(message.text()); });
  page.on("dialog", (dialog) => { page.problems.push("a dialog opened"); dialog.dismiss(); });
  page.on("request", (request) => {
    if (request.url() !== address && !/^(data|blob):/.test(request.url())) page.problems.push(`asked for ${request.url()}`);
  });
  await page.goto(address);
  assert.equal(await page.evaluate(() => document.documentElement.dataset.ready), "yes", "the script ran to its end");
  return page;
}

const scene = (page, k) => page.locator(`#scene-${k}`);
const viewer = (page, k) => scene(page, k).locator(".viewer canvas");
const shown = (page, k) => viewer(page, k).getAttribute("data-shown");
const pixels = (page, k) => viewer(page, k).evaluate((canvas) => canvas.toDataURL());
async function waitForShown(page, k, name) {
  await page.waitForFunction(([k, name]) => document.querySelector(`#scene-${k} .viewer canvas`).dataset.shown === name, [k, name]);
}

const tests = {
  async "has all scenes, and names as text"(page) {
    const headings = await page.locator("section > h2").allTextContents();
    assert.deepEqual(headings.slice(0, -1), summary.scenes.map((s) => s.scene));
    assert.equal(await page.locator("img").count(), 0, "no markup from names");
    assert.ok(statSync(`${folder}/report.html`).size < 3e7);
  },

  async "plots have a line for each sampler"(page) {
    const plots = scene(page, 0).locator(".plot");
    assert.equal(await plots.count(), 4, "two of errors, two of spectra");
    for (let i = 0; i < 4; ++i) assert.equal(await plots.nth(i).locator(".median").count(), samplers.length, `plot ${i}`);
    const seeds = samplers.length * summary.spp.length * summary.seeds;
    assert.equal(await plots.nth(0).locator("circle.seed").count(), seeds);
    const looks = await plots.nth(0).locator(".median").evaluateAll((lines) => lines.map((l) => getComputedStyle(l).stroke));
    assert.equal(new Set(looks).size, samplers.length, "each in its own colour");
  },

  async "the chosen metric and samplers are shown"(page) {
    const lines = scene(page, 0).locator(".plot .median");
    await page.locator(".bar .chip").nth(1).click();
    assert.equal(await lines.count(), 4 * (samplers.length - 1));
    await page.locator(".bar .chip").nth(1).click();
    assert.equal(await lines.count(), 4 * samplers.length);
    await page.locator("#metric").selectOption("rmse");
    assert.match(await scene(page, 0).locator(".plot h4").first().textContent(), /^RMSE/);
    await page.locator("#metric").selectOption("flip_ldr");
  },

  // The value under a dot is that of the row of errors.csv that the dot says it is.
  async "hovering shows the value in errors.csv"(page) {
    const rows = errorRows(), plot = scene(page, 0).locator(".plot").first();
    await plot.scrollIntoViewIfNeeded();
    await page.mouse.wheel(0, -150);
    const dots = plot.locator("circle.seed");
    let compared = 0;
    for (let i = 0; i < await dots.count(); i += 3) {
      const box = await dots.nth(i).boundingBox();
      await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
      const lines = await plot.locator(".tip div").allTextContents();
      const named = /^(.*), (\d+) spp, seed (\d+)$/.exec(lines[0]);
      if (!named) continue;  // the median of the seeds stands here too
      const row = rows.find((r) => r.scene === summary.scenes[0].scene && r.sampler === named[1] && r.spp === named[2] && r.seed === named[3]);
      const value = Number(/^FLIP (\S+)$/.exec(lines[1])[1]), time = Number(/^CPU time (\S+) s$/.exec(lines[2])[1]);
      assert.ok(Math.abs(value / Number(row.flip_ldr) - 1) < 1e-5, `${lines[0]}: ${value}, in the file ${row.flip_ldr}`);
      assert.ok(Math.abs(time / Number(row.cpu_seconds) - 1) < 1e-5, `${lines[0]}: ${time} s, in the file ${row.cpu_seconds}`);
      ++compared;
    }
    assert.ok(compared >= 4, `${compared} dots compared`);
  },

  async "plots zoom, and show all again"(page) {
    const plot = scene(page, 0).locator(".plot").first();
    const labels = () => plot.locator("svg text").allTextContents();
    const before = await labels();
    const box = await plot.locator(".drag .background").boundingBox();
    await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.3 * box.height);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.6 * box.height, { steps: 3 });
    await page.mouse.up();
    assert.notDeepEqual(await labels(), before);
    await plot.getByRole("button", { name: "Show all" }).click();
    assert.deepEqual(await labels(), before);
  },

  async "arrow keys go through the points of a plot"(page) {
    const plot = scene(page, 0).locator(".plot").first();
    await plot.locator("svg").focus();
    await page.keyboard.press("ArrowRight");
    assert.match(await plot.locator(".tip").textContent(), /^random, 1 spp, median of 3 seeds/);
    await page.keyboard.press("Escape");
  },

  async "keys switch images"(page) {
    await viewer(page, 0).scrollIntoViewIfNeeded();
    await viewer(page, 0).focus();
    const names = ["reference", ...samplers], images = new Set();
    for (const [i, name] of names.entries()) {
      await page.keyboard.press(String(i + 1));
      await waitForShown(page, 0, name);
      images.add(await pixels(page, 0));
    }
    assert.equal(images.size, names.length, "all images differ");
    await page.keyboard.press("r");
    await waitForShown(page, 0, "reference");
    await page.keyboard.press("r");
    await waitForShown(page, 0, names.at(-1));
  },

  async "exposure and error maps change the image"(page) {
    const brightness = () => viewer(page, 0).evaluate((canvas) => {
      const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
      return data.reduce((sum, v) => sum + v, 0) / data.length;
    });
    const settled = async (act) => {
      const before = await pixels(page, 0);
      await act();
      await page.waitForFunction((old) => document.querySelector("#scene-0 .viewer canvas").toDataURL() !== old, before);
    };
    const normal = await brightness();
    await settled(() => scene(page, 0).locator("input[type=range]").fill("2"));
    assert.ok(await brightness() > normal + 5);
    await settled(() => scene(page, 0).locator("input[type=range]").fill("0"));
    for (const view of ["signed", "absolute", "relative", "flip"]) {
      await settled(() => scene(page, 0).locator("select.view").selectOption(view));
    }
    assert.match(await scene(page, 0).locator(".scale").textContent(), /FLIP/);
    await settled(() => scene(page, 0).locator("select.view").selectOption("image"));
  },

  // The mean of the FLIP values read off pixels is near the image's; every 9th pixel is read.
  async "pixel values belong to the image"(page) {
    await page.keyboard.press("2");
    await waitForShown(page, 0, samplers[0]);
    const box = await viewer(page, 0).boundingBox(), [width, height] = summary.scenes[0].resolution;
    const zoom = Math.min(box.width / width, box.height / height);
    const left = box.x + (box.width - zoom * width) / 2, top = box.y + (box.height - zoom * height) / 2;
    const values = [];
    for (let y = 2; y < height; y += 9) {
      for (let x = 3; x < width; x += 9) {
        await page.mouse.move(left + (x + 0.5) * zoom, top + (y + 0.5) * zoom);
        const readout = scene(page, 0).locator(".readout");
        await page.waitForFunction((text) => document.querySelector("#scene-0 .readout").textContent.startsWith(text), `pixel ${x}, ${y}`);
        const text = await readout.textContent();
        assert.match(text, /random [\d.]/);
        values.push(Number(/FLIP ([\d.]+)/.exec(text)[1]));
      }
    }
    const spp = Number(/(\d+) spp/.exec(await scene(page, 0).locator(".caption").textContent())[1]);
    const row = errorRows().find((r) => r.scene === summary.scenes[0].scene && r.sampler === samplers[0] && r.spp === String(spp) && r.seed === "0");
    const mean = values.reduce((a, b) => a + b) / values.length;
    const deviation = Math.sqrt(values.reduce((sum, v) => sum + (v - mean) ** 2, 0) / (values.length - 1));
    // Four standard errors of the mean: a chance of 1 in 10,000, and the image is the same each time.
    assert.ok(Math.abs(mean - Number(row.flip_ldr)) < 4 * deviation / Math.sqrt(values.length), `${mean} against ${row.flip_ldr}`);
  },

  // The page's half floats, as a display shows them, are the 8-bit previews that the program writes.
  async "images are those of the files"(page) {
    const first = summary.scenes[0], rungs = first.samplers.map((s) => s.rungs.at(-1));
    await scene(page, 0).locator(".viewer select").first().selectOption({ label: `${summary.spp.at(-1)} samples per pixel` });
    const files = [first.reference.png, ...rungs.map((rung) => rung.png)];
    for (const [i, file] of files.entries()) {
      await page.keyboard.press(String(i + 1));
      await waitForShown(page, 0, ["reference", ...samplers][i]);
      const download = page.waitForEvent("download");
      await scene(page, 0).getByRole("button", { name: "Save the image" }).click();
      const images = [await (await download).path(), `${folder}/${file}`].map((path) => readFileSync(path).toString("base64"));
      const farthest = await page.evaluate(async (images) => {
        const [a, b] = await Promise.all(images.map(async (text) => {
          const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
          const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
          const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
          context.drawImage(bitmap, 0, 0);
          return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
        }));
        return a.length === b.length ? a.reduce((most, v, k) => Math.max(most, Math.abs(v - b[k])), 0) : "another size";
      }, images);
      assert.ok(farthest <= 1, `${file}: ${farthest}`);
    }
  },

  async "crops stand beside the reference"(page) {
    const crops = scene(page, 0).locator(".crops tbody tr");
    assert.equal(await crops.count(), 3);
    assert.equal(await crops.first().locator("canvas").count(), 1 + samplers.length);
    await scene(page, 0).getByRole("button", { name: "Remove crop 1" }).click();
    await page.waitForFunction(() => document.querySelectorAll("#scene-0 .crops tbody tr").length === 2);
  },

  async "plots are saved as SVG"(page) {
    const download = page.waitForEvent("download");
    await scene(page, 0).locator(".plot").first().getByRole("button", { name: /SVG/ }).click();
    const text = readFileSync(await (await download).path(), "utf8");
    assert.match(text, /^<svg[^]*<\/svg>$/);
    for (const name of samplers) assert.ok(text.includes(`>${name}<`), `legend has ${name}`);
    assert.ok(!text.includes("var(--"), "colours are spelt out");
  },

  async "commands and versions are given"(page) {
    const settings = await page.locator("#settings").textContent();
    assert.ok(settings.includes(summary.command), "this comparison's command");
    assert.ok(settings.includes("--sampler rcs:"), "commands of single images");
    assert.ok(settings.includes(summary.versions.Embree));
  },
};

let failed = 0, passed = 0;
async function check(name, page, test) {
  try {
    await test(page);
    assert.deepEqual(page.problems, [], "no errors in the page");
    ++passed;
  } catch (error) {
    ++failed;
    console.log(`FAILED: ${name}\n${error.stack}`);
  }
}

const browser = await chromium.launch({ executablePath: executable, args: ["--no-sandbox"] });
try {
  const page = await open(browser, { viewport: { width: 1400, height: 900 } });
  for (const [name, test] of Object.entries(tests)) await check(name, page, test);
  for (const scheme of ["light", "dark"]) {
    const phone = await open(browser, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, colorScheme: scheme });
    await check(`fits a phone, ${scheme}`, phone, async () => {
      assert.ok(await phone.evaluate(() => document.documentElement.scrollWidth) <= 390, "no scrolling sideways");
      await viewer(phone, 1).scrollIntoViewIfNeeded();
      await waitForShown(phone, 1, samplers[0]);
      await viewer(phone, 1).tap();
      await phone.waitForFunction(() => /^pixel \d+, \d+random/.test(document.querySelector("#scene-1 .readout").textContent));
    });
  }
} finally {
  await browser.close();
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
