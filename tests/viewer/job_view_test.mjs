import assert from "node:assert/strict";
import test from "node:test";

import { describe, final_frames, make_job_view, percent, state_of, points_of, take_event } from "../../service/viewer/job_view.js";

const job = { id: "j", first_frame: 3, last_frame: 9, state: "running", frames: [] };
const image = (frame, final, more = {}) => ({ frame, revision: 1, url: `/${frame}`, final, residual: 0.1, error_bound: null, ...more });

test("frames go from queued to coarse to converged", () => {
  let view = make_job_view(job);
  assert.equal(state_of(view, 4), "queued");
  view = take_event(view, "image", image(4, false), 1);
  assert.equal(state_of(view, 4), "coarse");
  view = take_event(view, "image", image(4, true, { error_bound: 0.02 }), 2);
  assert.equal(state_of(view, 4), "converged");
  assert.deepEqual(final_frames(view), [4]);
  assert.equal(describe(view, 4), "frame 4, converged, within 2.0 %");
});

test("a snapshot replaces what is known of frames and keeps the curve", () => {
  let view = take_event(make_job_view(job), "image", image(4, false), 10);
  view = take_event(view, "image", image(5, false), 12);
  view = take_event(view, "snapshot", { ...job, frames: [{ frame: 7, final: true, png: "/7", error_bound: 0.1 }] }, 13);
  assert.equal(state_of(view, 5), "queued");
  assert.equal(view.frames.get(7).url, "/7");
  assert.deepEqual(view.points.map((p) => p.time_s), [0, 2]);
});

test("a curve has the certificate where there is one, and no zeros, which its scale cannot show", () => {
  let view = take_event(make_job_view(job), "image", image(4, false, { residual: 0.3 }), 1);
  view = take_event(view, "image", image(4, true, { error_bound: 0.01 }), 2);
  view = take_event(view, "image", image(5, true, { residual: 0 }), 3);
  assert.deepEqual(view.points.map((p) => p.error), [0.3, 0.01]);
});

test("an edit makes pictures stale from its first frame on, until there are new ones", () => {
  let view = make_job_view({ ...job, revision: 0 });
  for (const frame of [4, 5, 6]) view = take_event(view, "image", image(frame, true, { error_bound: 0.02 }), 1);
  view = take_event(view, "edit", { revision: 1, first_frame: 5, reused: null }, 2);
  assert.deepEqual([4, 5, 6, 7].map((frame) => state_of(view, frame)), ["converged", "stale", "stale", "queued"]);
  assert.equal(describe(view, 5), "frame 5, stale");
  assert.equal(view.job.revision, 1);
  view = take_event(view, "reused", { revision: 1, reused: 0.87 }, 3);
  assert.equal(view.job.reused, 0.87);
  view = take_event(view, "image", image(5, false, { revision: 1001, stale: false }), 4);
  view = take_event(view, "image", image(6, true, { revision: 4, stale: true }), 5);
  assert.deepEqual([5, 6].map((frame) => state_of(view, frame)), ["coarse", "stale"]);
  assert.deepEqual(view.points.length, 4, "a picture that was stale when it came is no progress");
});

test("shares read as percentages of two digits", () => {
  assert.deepEqual([0.0123, 0.5, 1, 12].map(percent), ["1.2 %", "50 %", "100 %", "1200 %"]);
});

test("what nobody watched is told by the frames that are finished", () => {
  const points = points_of([
    { frame: 0, seconds: 1.5, residual: 0.01, error_bound: 0.02 },
    { frame: 1, seconds: 2, residual: 0.01, error_bound: null },
    { frame: 2, seconds: 2.5, residual: 0, error_bound: null },
  ]);
  assert.deepEqual(points, [
    { time_s: 1.5, frame: 0, error: 0.02, final: true },
    { time_s: 2, frame: 1, error: 0.01, final: true },
  ]);
});
