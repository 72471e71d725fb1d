import assert from "node:assert/strict";
import test from "node:test";

import { columns } from "../../service/viewer/chart.js";
import { dim_of, lamps_of, move_of, said_of } from "../../service/viewer/edit_panel.js";
import { settings_of } from "../../service/viewer/job_list.js";
import { facts_of } from "../../service/viewer/job_panel.js";
import { next_final } from "../../service/viewer/player.js";
import { difference } from "../../service/viewer/stage.js";

test("differences are amplified, clipped and opaque", () => {
  assert.deepEqual([...difference([10, 200, 3, 255], [12, 100, 3, 255], 8)], [16, 255, 0, 255]);
});

test("playback goes from one finished frame to the next and begins anew", () => {
  assert.equal(next_final([2, 5, 9], 2), 5);
  assert.equal(next_final([2, 5, 9], 6), 9);
  assert.equal(next_final([2, 5, 9], 9), 2);
  assert.equal(next_final([], 4), 4);
});

test("preliminary and final errors are two curves over one time", () => {
  const { data } = columns([{ time_s: 2, error: 0.1, final: true }, { time_s: 1, error: 0.3, final: false }]);
  assert.deepEqual(data, [[1, 2], [0.3, null], [null, 0.1]]);
});

test("a form left as it is asks for all frames", () => {
  const form = new Map([["size", "640x360"], ["quality", "draft"], ["method", "auto"], ["frames", ""]]);
  assert.deepEqual(settings_of(form), { quality: "draft", method: "auto", width: 640, height: 360 });
  form.set("frames", "0-4");
  assert.equal(settings_of(form).frames, "0-4");
});

test("edits are sent as the interface has them, and none that change nothing", () => {
  assert.deepEqual(move_of("chair", [0.1, 0, -2]), { move: { node: "chair", translation: [0.1, 0, -2] } });
  assert.equal(move_of("chair", [0, 0, 0]), null);
  assert.deepEqual(dim_of({ kind: "material", name: "lamp" }, 35), { light: { material: "lamp", emission_scale: 0.35 } });
  assert.deepEqual(dim_of({ kind: "lamp", name: "spot" }, 0), { light: { lamp: "spot", intensity_scale: 0 } });
});

test("what gives light can be dimmed, and what shares a name is told apart", () => {
  const materials = [{ material: "wall", emission_scale: null }, { material: "ceiling", emission_scale: 0 }, { material: "a", emission_scale: 1 }];
  const lamps = [{ lamp: "spot", intensity_scale: 2 }, { lamp: "off", intensity_scale: null }, { lamp: "a", intensity_scale: 1 }];
  const found = lamps_of({ materials, lamps });
  assert.deepEqual(found.map((lamp) => lamp.label), ["ceiling", "a (material)", "spot", "a (lamp)"], "one that is dimmed to nothing is still a lamp");
  assert.deepEqual(found[2], { kind: "lamp", name: "spot", scale: 2, label: "spot" });
});

test("what an edit kept is said once it is known", () => {
  assert.equal(said_of({ revision: 0, reused: null }), "");
  assert.equal(said_of({ revision: 1, reused: null }), "1 edit; the newest is being taken over");
  assert.equal(said_of({ revision: 2, reused: 0.873 }), "2 edits; the newest kept 87 % of all lines");
});

test("a failed job says why", () => {
  const facts = new Map(facts_of({ state: "failed", error: { detail: "out of memory" }, progress: 0.5 }));
  assert.equal(facts.get("State"), "failed: out of memory");
});
