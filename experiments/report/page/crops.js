// Enlarged crops below the viewer, as papers print them: one row for each place, the reference and all
// methods side by side.

const cropColours = ["#ffb000", "#00c2d1", "#ff5fa2", "#8ed100", "#b28dff", "#ff7a3d"];
const cropWidths = [110, 230];  // least and most CSS pixels of a crop on the page

// Places where the methods differ most: blocks whose mean FLIP spreads farthest, apart from each other.
function differingBlocks(maps, width, height, size, count) {
  const blocks = [];
  const step = { x: Math.max(1, size.width >> 1), y: Math.max(1, size.height >> 1) };
  for (let y = 0; y + size.height <= height; y += step.y) {
    for (let x = 0; x + size.width <= width; x += step.x) {
      const means = maps.map((map) => {
        let sum = 0;
        for (let v = y; v < y + size.height; ++v) for (let u = x; u < x + size.width; ++u) sum += map[v * width + u];
        return sum;
      });
      blocks.push({ x, y, spread: d3.max(means) - d3.min(means) });
    }
  }
  blocks.sort((a, b) => b.spread - a.spread);
  const chosen = [];
  blocks.forEach((block) => {
    const apart = chosen.every((c) => Math.abs(c.x - block.x) >= 1.5 * size.width || Math.abs(c.y - block.y) >= 1.5 * size.height);
    if (chosen.length < count && apart) chosen.push({ x: block.x, y: block.y });
  });
  return chosen;
}

// `viewer` has its state (methods, view), the image's size, picture(method), redraw() and goTo(x, y).
function imageCrops(section, scene, viewer) {
  const size = { width: Math.min(viewer.width, Math.max(16, Math.round(viewer.width / 7))) };
  size.height = Math.min(viewer.height, Math.round(0.75 * size.width));
  let places = [];
  const box = section.append("div").attr("class", "crops");
  const controls = section.append("div").attr("class", "controls");
  button(controls, "Save crops as PNG", "Save what is shown of the crops, for a figure", saveCrops);
  controls.append("span").attr("class", "muted").text(
    "Crops are where the methods' FLIP differs most; click one to see it in the viewer, × removes it.");

  async function draw() {
    const methods = viewer.state.methods;
    const pictures = await Promise.all(methods.map(viewer.picture));
    if (methods !== viewer.state.methods) return;
    const room = box.node().clientWidth / methods.length - 12;
    const shownWidth = Math.floor(Math.max(cropWidths[0], Math.min(cropWidths[1], room)));
    box.html("");
    const table = box.append("table");
    table.append("thead").append("tr").selectAll("th").data(methods).enter().append("th").attr("scope", "col").text((m) => m.name)
      .style("max-width", `${shownWidth}px`);
    const rows = table.append("tbody").selectAll("tr").data(places).enter().append("tr");
    rows.each(function (place, k) {
      const row = d3.select(this);
      pictures.forEach((picture, i) => {
        const cell = row.append("td");
        const canvas = cell.append("canvas").attr({ width: size.width, height: size.height, role: "img",
          "aria-label": `crop ${k + 1} of ${methods[i].name}` })
          .style({ width: `${shownWidth}px`, "border-color": cropColours[k % cropColours.length] });
        canvas.node().getContext("2d").drawImage(picture, -place.x, -place.y);
        canvas.on("click", () => viewer.goTo(place.x + size.width / 2, place.y + size.height / 2));
        if (i === 0) button(cell, "×", `Remove crop ${k + 1}`, () => remove(k)).attr("class", "remove");
      });
    });
    controls.style("display", places.length ? null : "none");
  }
  function remove(k) {
    places.splice(k, 1);
    draw();
    viewer.redraw();
  }

  // All crops as one image, each pixel as 4 x 4, with the methods' names above.
  async function saveCrops() {
    const methods = viewer.state.methods, pictures = await Promise.all(methods.map(viewer.picture));
    const scale = 4, gap = 4, head = 24, w = scale * size.width, h = scale * size.height;
    const sheet = document.createElement("canvas");
    sheet.width = methods.length * (w + gap) - gap;
    sheet.height = head + places.length * (h + gap) - gap;
    const context = sheet.getContext("2d");
    context.fillStyle = "#fff";
    context.fillRect(0, 0, sheet.width, sheet.height);
    context.fillStyle = "#000";
    context.font = "15px sans-serif";
    context.textAlign = "center";
    context.imageSmoothingEnabled = false;
    pictures.forEach((picture, i) => {
      context.fillText(methods[i].name, i * (w + gap) + w / 2, 17, w);
      places.forEach((place, k) => context.drawImage(picture, place.x, place.y, size.width, size.height,
        i * (w + gap), head + k * (h + gap), w, h));
    });
    sheet.toBlob((blob) => save(`${fileNameSafe(scene.label)}-crops-${viewer.state.view.name}.png`, blob));
  }

  return {
    draw,
    add(x, y) {
      const within = (middle, length, all) => Math.round(Math.max(0, Math.min(all - length, middle - length / 2)));
      places.push({ x: within(x, size.width, viewer.width), y: within(y, size.height, viewer.height) });
      draw();
      viewer.redraw();
    },
    choose(maps, count) {
      places = maps.length ? differingBlocks(maps, viewer.width, viewer.height, size, count) : [];
    },
    // Where the crops are, on the viewer's canvas.
    outline(context, corner) {
      places.forEach((place, k) => {
        context.lineWidth = 2;
        context.strokeStyle = cropColours[k % cropColours.length];
        context.strokeRect(corner.x + place.x * corner.z, corner.y + place.y * corner.z, size.width * corner.z, size.height * corner.z);
      });
    },
  };
}
