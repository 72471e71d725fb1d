// What is known of a job, in words, and the buttons that steer it.

import { post_json } from "./api.js";
import { said_of } from "./edit_panel.js";
import { percent } from "./job_view.js";

const steps = {
  queued: ["pause", "cancel"], running: ["pause", "cancel"], paused: ["resume", "cancel"],
  failed: ["retry"], cancelled: ["retry"], succeeded: [],
};

/** Rows of the panel: what, and how much. */
export function facts_of(job) {
  const count = (n) => n.toLocaleString("en");
  const facts = [
    ["State", job.error ? `${job.state}: ${job.error.detail}` : job.state],
    ["Progress", `${percent(job.progress)} ${job.doing ?? ""}`.trim()],
  ];
  if (job.remaining_s != null) facts.push(["Remaining", `${Math.ceil(job.remaining_s)} s`]);
  if (job.revision) facts.push(["Edits", said_of(job)]);
  const known = job.statistics ?? {};
  if (known.method) facts.push(["Method", known.method_reason ? `${known.method}: ${known.method_reason}` : known.method]);
  if (known.patches) facts.push(["Patches", `${count(known.patches)}, ${count(known.actor_patches)} of them on actors`]);
  if (known.sight_lines) facts.push(["Sight lines", count(known.sight_lines)]);
  for (const warning of job.warnings ?? []) facts.push(["Warning", `${warning.place}: ${warning.message}`]);
  return facts;
}

/** `on_step(id)` hears that a step was taken: a job that had ended goes on after `retry`. */
export function make_job_panel({ facts, controls, on_step, on_problem }) {
  let shown = "";

  const button = (job, step) => {
    const element = document.createElement("button");
    element.textContent = step;
    element.addEventListener("click", () => post_json(`/v1/jobs/${job.id}/${step}`).then(() => (on_problem(null), on_step(job.id)), on_problem));
    return element;
  };

  return {
    show(job) {
      facts.replaceChildren(...facts_of(job).flatMap(([name, value]) => {
        const term = document.createElement("dt");
        const text = document.createElement("dd");
        term.textContent = name;
        text.textContent = value;
        return [term, text];
      }));
      const state = `${job.id} ${job.state}`;
      if (state === shown) return;
      shown = state;
      controls.replaceChildren(...(steps[job.state] ?? []).map((step) => button(job, step)));
    },
  };
}
