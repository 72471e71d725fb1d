// What the page knows of one job, and how events change it. No page, no network: plain values.

/** A frame is `queued` without a picture, `coarse` with a preliminary one, `converged` with a final one. */
export function make_job_view(job) {
  const view = { job, first: job.first_frame, last: job.last_frame, frames: new Map(), points: [], began: null };
  for (const frame of job.frames ?? []) take_picture(view, { ...frame, url: frame.png });
  return view;
}

export function state_of(view, frame) {
  return view.frames.get(frame)?.state ?? "queued";
}

export function final_frames(view) {
  return [...view.frames.values()].filter((f) => f.final).map((f) => f.frame).sort((a, b) => a - b);
}

/** Takes over an event of the service's interface. `now_s` is the time since the page began, in seconds. */
export function take_event(view, name, data, now_s) {
  if (name === "snapshot") {
    const fresh = make_job_view(data);
    return { ...fresh, points: view.points, began: view.began };
  }
  if (name === "job") return { ...view, job: data };
  if (name === "progress") return { ...view, job: { ...view.job, ...data } };
  if (name === "image") {
    view.began ??= now_s;
    take_picture(view, data);
    const error = data.error_bound ?? data.residual;
    if (error > 0) view.points.push({ time_s: now_s - view.began, frame: data.frame, error, final: data.final });
  }
  return view;
}

function take_picture(view, picture) {
  view.frames.set(picture.frame, { ...picture, state: picture.final ? "converged" : "coarse" });
}

/** In words, for people who listen to the page. */
export function describe(view, frame) {
  const known = view.frames.get(frame);
  if (!known) return `frame ${frame}, queued`;
  const error = known.error_bound == null ? "" : `, within ${percent(known.error_bound)}`;
  return `frame ${frame}, ${known.state}${error}`;
}

export function percent(share) {
  const value = 100 * share;
  return `${value < 10 ? value.toPrecision(2) : Math.round(value)} %`;
}
