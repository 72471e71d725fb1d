// What the page knows of one job, and how events change it. No page, no network: plain values.

/** A frame is `queued` without a picture, `stale` with one from before an edit, `coarse` with a preliminary one, `converged` with a final one. */
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
  if (name === "edit") {
    for (const [frame, picture] of view.frames) if (frame >= data.first_frame) take_picture(view, { ...picture, stale: true });
    return { ...view, job: { ...view.job, revision: data.revision, reused: data.reused } };
  }
  if (name === "reused") return data.revision === view.job.revision ? { ...view, job: { ...view.job, reused: data.reused } } : view;
  if (name === "image") {
    view.began ??= now_s;
    take_picture(view, data);
    const error = data.error_bound ?? data.residual;
    if (error > 0 && !data.stale) view.points.push({ time_s: now_s - view.began, frame: data.frame, error, final: data.final });
  }
  return view;
}

/** Points of the chart out of a reply of `/convergence`. */
export function points_of(frames) {
  return frames
    .map((f) => ({ time_s: f.seconds, frame: f.frame, error: f.error_bound ?? f.residual, final: true }))
    .filter((p) => p.error > 0);
}

function take_picture(view, picture) {
  const state = picture.stale ? "stale" : picture.final ? "converged" : "coarse";
  view.frames.set(picture.frame, { ...picture, state });
}

/** In words, for people who listen to the page. */
export function describe(view, frame) {
  const known = view.frames.get(frame);
  if (!known) return `frame ${frame}, queued`;
  const error = known.error_bound == null || known.stale ? "" : `, within ${percent(known.error_bound)}`;
  return `frame ${frame}, ${known.state}${error}`;
}

export function percent(share) {
  const value = 100 * share;
  return `${value < 10 ? value.toPrecision(2) : Math.round(value)} %`;
}
