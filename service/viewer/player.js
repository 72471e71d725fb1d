// Which frame is shown, playback of finished ones, and what it is compared with.

import { final_frames, describe, make_job_view } from "./job_view.js";
import { get_json } from "./api.js";
import { make_pictures } from "./pictures.js";
import { draw } from "./stage.js";

/** The finished frame after `frame`, beginning anew behind the last one. */
export function next_final(frames, frame) {
  return frames.find((f) => f > frame) ?? frames[0] ?? frame;
}

/** `elements`: canvas, wipe, compare, other_job, other_frame, play, frame. `on_frame(frame)` hears of every choice. */
export function make_player(elements, on_frame, on_problem) {
  const pictures = make_pictures();
  let view = null;
  let other = null;  // the view of the job compared with
  let frame = 0;
  let timer = null;
  let drawing = null;  // what is being drawn, and whether it must be drawn again after that

  const known = (v, f) => v?.frames.get(f);

  const draw_now = async () => {
    const mode = elements.compare.value;
    const a = known(view, frame);
    if (!a) return;
    const against = elements.other_frame.value === "" ? frame : Number(elements.other_frame.value);
    const b = mode === "none" ? null : known(other ?? view, against);
    const [picture, second] = await Promise.all([a, b].map((p) => p && pictures.get(p.url, p.final)));
    draw(elements.canvas, { a: picture, b: second, mode, share: elements.wipe.value / 100 });
    elements.canvas.setAttribute("aria-label", describe(view, frame) + (second ? `, ${mode} with frame ${against}` : ""));
  };

  // One drawing at a time, and after it the newest wish only.
  const refresh = async () => {
    if (drawing) return void (drawing.again = true);
    drawing = { again: true };
    while (drawing.again) {
      drawing.again = false;
      // A picture that has gone has a successor, whose event is on its way.
      await draw_now().catch((problem) => problem.status !== 410 && on_problem(problem));
    }
    drawing = null;
  };

  const choose = (f) => {
    frame = f;
    elements.frame.value = describe(view, frame);
    on_frame(frame);
    return refresh();
  };

  const stop = () => {
    clearTimeout(timer);
    timer = null;
    elements.play.setAttribute("aria-pressed", "false");
    elements.play.textContent = "Play";
  };

  const play = () => {
    const tick = async () => {
      const began = performance.now();
      await choose(next_final(final_frames(view), frame));
      const period_ms = 1000 / (view.job.frames_per_second);
      if (timer !== null) timer = setTimeout(tick, Math.max(0, period_ms - (performance.now() - began)));
    };
    elements.play.setAttribute("aria-pressed", "true");
    elements.play.textContent = "Pause";
    timer = setTimeout(tick, 0);
  };

  const compare = async () => {
    const mode = elements.compare.value;
    elements.wipe.hidden = mode !== "wipe";
    for (const label of document.querySelectorAll("#transport .other")) label.hidden = mode === "none";
    const id = elements.other_job.value;
    other = null;
    if (mode !== "none" && id && id !== view?.job.id) {
      const [job, { frames }] = await Promise.all([get_json(`/v1/jobs/${id}`), get_json(`/v1/jobs/${id}/frames`)]);
      other = make_job_view({ ...job, frames });
    }
    await refresh();
  };

  for (const name of ["compare", "other_job", "other_frame"]) elements[name].addEventListener("change", () => compare().catch(on_problem));
  elements.wipe.addEventListener("input", refresh);
  elements.play.addEventListener("click", () => (timer === null ? view && play() : stop()));

  return {
    choose: (f) => view && choose(Math.min(Math.max(f, view.first), view.last)),
    step: (by) => view && choose(Math.min(Math.max(frame + by, view.first), view.last)),
    frame: () => frame,
    /** Takes over a job as it is now; where another one was shown, from its first frame. */
    show(new_view) {
      const is_new = view?.job.id !== new_view.job.id;
      view = new_view;
      if (is_new) {
        stop();
        choose(view.first);
      } else {
        elements.frame.value = describe(view, frame);
        refresh();
      }
    },
  };
}
