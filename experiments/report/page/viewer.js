// The image viewer: the reference and all methods at one zoom, place, exposure and kind of error map.

const largestZoom = 64;
const stopsRange = [-8, 14];

function imageViewer(section, scene, index) {
  const choices = imageChoices(scene, index);
  if (!choices.length) return;
  const [width, height] = index.size;
  const state = { choice: choices[0], methods: [], at: 0, before: 0, view: views[0], stops: { image: 0, error: 0, relative: 0 },
    zoom: 0, x: width / 2, y: height / 2, cursor: null };  // zoom 0: all of it; x, y: the middle in pixels

  section.append("h3").text("Images");
  if (typeof DecompressionStream === "undefined") {
    section.append("p").attr("class", "note").text(
      "This browser cannot unpack the images in this page (Chromium 80, Firefox 113 and Safari 16.4 can). They are in files beside it.");
    return;
  }
  section.append("p").attr("class", "muted").text(
    `First seed. Keys: 1 to 9 choose an image (0 is the tenth), R goes to the reference and back, E to the next kind of map, ` +
    `[ and ] (or comma and full stop) change the exposure, + and − zoom, F shows all. Drag to move; the wheel zooms where Ctrl is held or the viewer has ` +
    `the focus.` + (index.factor > 1 ? ` To keep this page small, ${index.factor} × ${index.factor} pixels are averaged to one ` +
    "here; the EXR files beside the page have all." : "") +
    (index.left_out ? ` ${index.left_out} more renders are in files beside the page.` : ""));
  const box = section.append("div").attr({ class: "viewer", role: "group", "aria-label": `Images of ${scene.label}` });
  const controls = box.append("div").attr("class", "controls");
  const tabs = box.append("div").attr({ class: "chips tabs", role: "group", "aria-label": "Image shown" });
  const canvas = box.append("canvas").attr({ tabindex: 0, role: "img" }).node();
  const readout = box.append("div").attr({ class: "readout" });
  const bar = box.append("div").attr("class", "scale");
  const caption = box.append("div").attr({ class: "caption", "aria-live": "polite" });

  // One canvas of image size for each method, painted again when view or exposure change.
  const painted = new Map();
  async function picture(method) {
    const view = state.view, gain = (kind) => Math.pow(2, state.stops[kind] || 0);
    const key = [method.ids.radiance, view.name, gain(view.stops), gain("image")].join(" ");
    if (painted.has(key)) return painted.get(key);
    const of = await decodedMethod(method, index);
    const rgba = view.paint(of, gain(view.stops)) || views[0].paint(of, gain("image"));
    const picture = document.createElement("canvas");
    picture.width = width;
    picture.height = height;
    picture.getContext("2d").putImageData(new ImageData(rgba, width, height), 0, 0);
    if (painted.size > 3 * state.methods.length) painted.clear();
    painted.set(key, picture);
    return picture;
  }

  const fit = () => Math.min(canvas.clientWidth / width, canvas.clientHeight / height);
  const zoom = () => state.zoom || fit();
  // The image's place on the canvas, in CSS pixels; all of it stands in the middle.
  function corner() {
    const z = zoom();
    const along = (middle, size, room) => (size * z <= room ? (room - size * z) / 2
      : Math.min(0, Math.max(room - size * z, room / 2 - middle * z)));
    return { x: along(state.x, width, canvas.clientWidth), y: along(state.y, height, canvas.clientHeight), z };
  }
  function pixelAt(event) {
    const rect = canvas.getBoundingClientRect(), place = corner();
    const x = Math.floor((event.clientX - rect.left - place.x) / place.z);
    const y = Math.floor((event.clientY - rect.top - place.y) / place.z);
    return x >= 0 && y >= 0 && x < width && y < height ? { x, y } : null;
  }

  let turn = 0;
  async function draw() {
    const mine = ++turn, method = state.methods[state.at];
    const image = await picture(method);
    if (mine !== turn) return;
    const dense = window.devicePixelRatio || 1;
    canvas.width = Math.round(canvas.clientWidth * dense);
    canvas.height = Math.round(canvas.clientHeight * dense);
    const context = canvas.getContext("2d"), place = corner();
    context.setTransform(dense, 0, 0, dense, 0, 0);
    context.imageSmoothingEnabled = place.z * dense < 1;
    context.imageSmoothingQuality = "high";
    context.drawImage(image, place.x, place.y, width * place.z, height * place.z);
    crops.outline(context, place);
    canvas.dataset.shown = method.name;
    canvas.setAttribute("aria-label", `${state.view.title} of ${method.name}`);
    showValues();
  }

  // Values of the pixel under the cursor; an answer that comes late is dropped.
  async function showValues() {
    const method = state.methods[state.at], pixel = state.cursor;
    const of = await decodedMethod(method, index);
    if (method === state.methods[state.at] && pixel === state.cursor) drawValues(readout, scene, index, method, of, pixel);
  }

  function mark() {
    tabs.selectAll("button").attr("aria-pressed", (d, i) => String(i === state.at));
    viewSelect.property("value", state.view.name);
    const set = state.stops[state.view.stops];
    exposureName.text(state.view.scale ? "Brightness of the map " : "Exposure ");
    exposure.property("value", set || 0).property("disabled", set === undefined);
    stops.text(set === undefined ? "fixed" : `${set > 0 ? "+" : ""}${set} stops`);
    drawScale(bar, scene, state);
    drawCaption(caption, state);
  }
  function refresh(cropsToo) {
    mark();
    draw();
    if (cropsToo) crops.draw();
  }
  function choose(i) {
    if (i < 0 || i >= state.methods.length) return false;
    if (i !== state.at) state.before = state.at;
    state.at = i;
    refresh(false);
    return true;
  }
  function look(view) {
    state.view = view;
    refresh(true);
  }
  function expose(stops) {
    if (state.view.stops) state.stops[state.view.stops] = Math.max(stopsRange[0], Math.min(stopsRange[1], stops));
    refresh(true);
  }
  const exposeBy = (stops) => expose(state.stops[state.view.stops] + stops);
  // Zooms by a factor; the pixel at a place on the canvas stays where it is.
  function zoomBy(factor, at) {
    const before = corner();
    const about = at || { x: canvas.clientWidth / 2, y: canvas.clientHeight / 2 };
    const pixel = { x: (about.x - before.x) / before.z, y: (about.y - before.y) / before.z };
    const z = Math.min(largestZoom, before.z * factor);
    state.zoom = z <= fit() * 1.001 ? 0 : z;
    state.x = pixel.x + (canvas.clientWidth / 2 - about.x) / z;
    state.y = pixel.y + (canvas.clientHeight / 2 - about.y) / z;
    canvas.style.touchAction = state.zoom ? "none" : "pan-y";
    draw();
  }
  function showAll() {
    state.zoom = 0;
    canvas.style.touchAction = "pan-y";
    draw();
  }
  function move(dx, dy) {
    const place = corner();
    // From where it stands, not from where it was asked to be.
    state.x = (canvas.clientWidth / 2 - place.x - dx) / place.z;
    state.y = (canvas.clientHeight / 2 - place.y - dy) / place.z;
    draw();
  }

  async function savePicture() {
    const method = state.methods[state.at], image = await picture(method);
    image.toBlob((blob) => save(`${fileNameSafe(`${scene.label}-${method.name}-${state.view.name}`)}.png`, blob));
  }

  function setMethods() {
    const name = state.methods.length ? state.methods[state.at].name : null;
    state.methods = methodsOf(scene, index, state.choice);
    const same = state.methods.findIndex((m) => m.name === name);
    state.at = same >= 0 ? same : Math.min(1, state.methods.length - 1);
    state.before = 0;
    tabs.html("");
    const items = tabs.selectAll("button").data(state.methods).enter().append("button").attr({ type: "button", class: "chip" });
    items.append("kbd").text((d, i) => (i < 10 ? (i + 1) % 10 : ""));
    items.each(function (d) { if (!d.reference) sample(d3.select(this), d.series); });
    items.append("span").text((d) => d.name);
    items.on("click", (d, i) => choose(i));
  }

  const select = controls.append("label").text("Show ").append("select");
  select.selectAll("option").data(choices).enter().append("option").attr("value", (d, i) => i).text((d) => d.text);
  select.on("change", () => {
    state.choice = choices[Number(select.property("value"))];
    painted.clear();
    setMethods();
    refresh(true);
  });
  const offered = views.filter((v) => v.name !== "weights" || index.runs.some((run) => run.weights));
  const viewSelect = controls.append("label").text("as ").append("select").attr("class", "view");
  viewSelect.selectAll("option").data(offered).enter().append("option").attr("value", (v) => v.name).text((v) => v.title);
  viewSelect.on("change", () => look(offered.find((v) => v.name === viewSelect.property("value"))));
  const exposureLabel = controls.append("label");
  const exposureName = exposureLabel.append("span");
  const exposure = exposureLabel.append("input").attr({ type: "range", min: stopsRange[0], max: stopsRange[1], step: 0.5, value: 0 });
  const stops = exposureLabel.append("output");
  exposure.on("input", () => expose(Number(exposure.property("value"))));
  const tools = controls.append("span").attr("class", "tools");
  button(tools, "+", "Zoom in", () => zoomBy(2));
  button(tools, "−", "Zoom out", () => zoomBy(0.5));
  button(tools, "1:1", "One image pixel on one pixel of the page", () => zoomBy(1 / zoom()));
  button(tools, "All", "Show all of the image", showAll);
  button(tools, "PNG", "Save the image as it is shown, whole and pixel by pixel", savePicture);
  button(tools, "Crop", "Add an enlarged crop of what is in the middle", () => crops.add(state.x, state.y));

  const crops = imageCrops(section, scene, { state, width, height, picture, redraw: draw,
    goTo: (x, y) => { state.zoom = Math.max(zoom(), 4 * fit()); state.x = x; state.y = y; canvas.style.touchAction = "none"; draw(); } });

  const actions = {
    r: () => choose(state.at === 0 ? state.before : 0),
    e: () => look(offered[(offered.indexOf(state.view) + 1) % offered.length]),
    f: showAll,
    "[": () => exposeBy(-1), "]": () => exposeBy(1),
    ",": () => exposeBy(-1), ".": () => exposeBy(1),
    "+": () => zoomBy(2), "=": () => zoomBy(2), "-": () => zoomBy(0.5),
    ArrowLeft: () => move(40, 0), ArrowRight: () => move(-40, 0), ArrowUp: () => move(0, 40), ArrowDown: () => move(0, -40),
  };
  const viewer = {
    node: box.node(),
    key(key) {
      if (/^[0-9]$/.test(key)) return choose((Number(key) + 9) % 10);
      const action = actions[key.length === 1 ? key.toLowerCase() : key];
      if (action) action();
      return Boolean(action);
    },
  };
  viewers.push(viewer);
  box.node().addEventListener("focusin", () => { activeViewer = viewer; });
  followPointers(canvas, {
    isZoomed: () => Boolean(state.zoom), move, zoomBy,
    touched: () => { activeViewer = viewer; },
    point(event) {
      state.cursor = event && pixelAt(event);
      showValues();
    },
  });

  function shape() {
    const room = canvas.clientWidth;
    canvas.style.height = `${Math.round(Math.min(room * height / width, Math.max(300, 0.72 * window.innerHeight)))}px`;
  }
  // Decoded when it comes near the window, so that a page of many scenes opens at once.
  const observer = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    observer.disconnect();
    setMethods();
    shape();
    mark();
    Promise.all(state.methods.filter((m) => !m.reference).map((m) => decodedMethod(m, index))).then((decoded) => {
      state.stops.error = errorStops(decoded);
      crops.choose(decoded.map((of) => of.flip), 3);
      refresh(true);
    });
    window.addEventListener("resize", () => { shape(); draw(); });
  }, { rootMargin: "400px" });
  observer.observe(box.node());
}
