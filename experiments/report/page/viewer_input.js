// Keys and pointers for image viewers.

// The viewer that keys are for: the one last touched, or else the first in sight.
const viewers = [];
let activeViewer = null;
const inSight = (viewer) => {
  const box = viewer.node.getBoundingClientRect();
  return box.bottom > 80 && box.top < window.innerHeight - 80;
};
document.addEventListener("keydown", (event) => {
  const form = event.target.closest && event.target.closest("input, select, textarea");
  if (event.ctrlKey || event.altKey || event.metaKey || (form && form.type !== "range")) return;
  if (form && event.key.startsWith("Arrow")) return;
  const viewer = activeViewer && inSight(activeViewer) ? activeViewer : viewers.find(inSight);
  const arrows = event.key.startsWith("Arrow") && !(viewer && viewer.node.contains(event.target));
  if (viewer && !arrows && viewer.key(event.key)) event.preventDefault();
});

// One pointer moves the image, two zoom it, and any points at a pixel. `viewer` has isZoomed(),
// move(dx, dy), zoomBy(factor, place on the canvas), touched() and point(event or null).
function followPointers(canvas, viewer) {
  const pointers = new Map();
  const onCanvas = (x, y) => {
    const rect = canvas.getBoundingClientRect();
    return { x: x - rect.left, y: y - rect.top };
  };
  canvas.addEventListener("pointerdown", (event) => {
    pointers.set(event.pointerId, event);
    viewer.touched();
    if (pointers.size === 1) viewer.point(event);
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    viewer.point(event);
    if (!last) return;
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, event);
    const other = [...pointers.values()].find((p) => p.pointerId !== event.pointerId);
    if (other) {
      const apart = (a) => Math.hypot(a.clientX - other.clientX, a.clientY - other.clientY);
      viewer.zoomBy(apart(event) / Math.max(1, apart(last)),
        onCanvas((event.clientX + other.clientX) / 2, (event.clientY + other.clientY) / 2));
    } else if (viewer.isZoomed()) {
      viewer.move(event.clientX - last.clientX, event.clientY - last.clientY);
    }
  });
  ["pointerup", "pointercancel"].forEach((name) => canvas.addEventListener(name, (event) => pointers.delete(event.pointerId)));
  canvas.addEventListener("pointerleave", (event) => {
    if (event.pointerType === "mouse" && !pointers.size) viewer.point(null);
  });
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== canvas) return;
    event.preventDefault();
    viewer.zoomBy(Math.pow(2, -Math.sign(event.deltaY) / 3), onCanvas(event.clientX, event.clientY));
  }, { passive: false });
}
