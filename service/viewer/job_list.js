// The list of jobs, and the form that adds one.

import { get_json, post_json, upload_scene } from "./api.js";

const refresh_ms = 3000;

/** The settings that a submitted form asks for, as in the service's interface. */
export function settings_of(form) {
  const [width, height] = form.get("size").split("x").map(Number);
  const settings = { quality: form.get("quality"), method: form.get("method"), width, height };
  if (form.get("frames")) settings.frames = form.get("frames");
  return settings;
}

function entry(job, chosen, on_choose) {
  const item = document.createElement("li");
  const button = document.createElement("button");
  button.textContent = job.id;
  button.dataset.job = job.id;
  button.setAttribute("aria-current", String(job.id === chosen));
  const detail = document.createElement("small");
  const asked = job.settings.method ?? `${job.settings.visibility}, ${job.settings.solution}`;
  detail.textContent = `${job.state}, ${job.frames_done} of ${job.last_frame - job.first_frame + 1} frames, ${asked}`;
  button.append(detail);
  button.addEventListener("click", () => on_choose(job.id));
  item.append(button);
  return item;
}

/** Keeps the list fresh. `on_jobs` hears of every new list, `on_choose(id)` of the user's choice. */
export function make_job_list({ list, form, on_choose, on_jobs, on_problem }) {
  let chosen = null;
  let shown = "";

  const refresh = async () => {
    const { jobs } = await get_json("/v1/jobs");
    const text = JSON.stringify([jobs, chosen]);
    // Left alone while nothing changed, so that the keyboard's focus stays where it is.
    if (text === shown) return;
    shown = text;
    const focus = document.activeElement?.dataset?.job;
    list.replaceChildren(...jobs.map((job) => entry(job, chosen, on_choose)));
    list.querySelector(`[data-job="${focus}"]`)?.focus();
    on_jobs(jobs);
  };

  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const button = form.querySelector("button");
    button.disabled = true;
    try {
      const values = new FormData(form);
      const scene = await upload_scene(values.get("scene"));
      const job = await post_json("/v1/jobs", { scene: scene.id, settings: settings_of(values) });
      on_problem(null);
      on_choose(job.id);
    } catch (problem) {
      on_problem(problem);
    } finally {
      button.disabled = false;
    }
  });

  const keep_fresh = async () => {
    // A service that does not answer is told by the connection's state; the list waits for it.
    if (!document.hidden) await refresh().catch((problem) => problem.status && on_problem(problem));
    setTimeout(keep_fresh, refresh_ms);
  };
  keep_fresh();

  return {
    /** Something of a job has changed that the list shows. */
    refresh: () => refresh().catch(() => {}),
    choose(id) {
      chosen = id;
      refresh().catch(on_problem);
    },
  };
}
