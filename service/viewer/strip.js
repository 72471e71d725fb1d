// The strip of frames: one column of colour a frame (or for several, where there are more frames than pixels), and the slider
// that goes through them.

import { describe, state_of } from "./job_view.js";

const order = ["queued", "stale", "coarse", "converged"];
const stale_height = 0.5;  // so that stale frames are told apart without colours too

/** Draws on `canvas` and calls `on_choose(frame)` when the user picks one by pointer or keys. */
export function make_strip(canvas, on_choose) {
  const colours = Object.fromEntries(order.map((state) => [state, getComputedStyle(document.documentElement).getPropertyValue(`--${state}`)]));
  let view = null;
  let chosen = 0;

  const frame_at = (x) => {
    const box = canvas.getBoundingClientRect();
    const share = Math.min(Math.max((x - box.left) / box.width, 0), 0.999999);
    return view.first + Math.floor(share * (view.last - view.first + 1));
  };
  const choose = (frame) => view && on_choose(Math.min(Math.max(frame, view.first), view.last));

  canvas.addEventListener("pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    if (view) choose(frame_at(e.clientX));
  });
  canvas.addEventListener("pointermove", (e) => {
    if (view && e.buttons & 1) choose(frame_at(e.clientX));
  });
  canvas.addEventListener("keydown", (e) => {
    const step = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: 10, PageDown: -10 }[e.key];
    if (step) choose(chosen + step);
    else if (e.key === "Home") choose(view?.first);
    else if (e.key === "End") choose(view?.last);
    else return;
    e.preventDefault();
  });

  const draw = () => {
    const width = (canvas.width = Math.max(1, Math.round(canvas.clientWidth * devicePixelRatio)));
    const height = (canvas.height = Math.round(36 * devicePixelRatio));
    const pen = canvas.getContext("2d");
    pen.clearRect(0, 0, width, height);
    if (!view) return;
    const count = view.last - view.first + 1;
    const columns = Math.min(count, width);
    for (let column = 0; column < columns; ++column) {
      // A column of several frames shows the least finished of them.
      const from = Math.floor((column * count) / columns);
      const to = Math.floor(((column + 1) * count) / columns);
      let worst = order.length - 1;
      for (let k = from; k < to; ++k) worst = Math.min(worst, order.indexOf(state_of(view, view.first + k)));
      pen.fillStyle = colours[order[worst]];
      const gap = columns < width / 4 ? 1 : 0;
      const tall = order[worst] === "stale" ? stale_height * height : height;
      pen.fillRect((column * width) / columns, height - tall, width / columns - gap, tall);
    }
    const x = ((chosen - view.first + 0.5) * width) / count;
    pen.fillStyle = "#fff";
    pen.fillRect(Math.round(x) - 1, 0, 3, height);
  };

  addEventListener("resize", draw);
  return {
    show(new_view, frame) {
      view = new_view;
      chosen = frame;
      canvas.setAttribute("aria-valuemin", view.first);
      canvas.setAttribute("aria-valuemax", view.last);
      canvas.setAttribute("aria-valuenow", frame);
      canvas.setAttribute("aria-valuetext", describe(view, frame));
      draw();
    },
  };
}
