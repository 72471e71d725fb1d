// Joins the parts of the page: one job is followed, and everything shows it.

import { get_json, set_token } from "./api.js";
import { follow } from "./events.js";
import { make_chart } from "./chart.js";
import { make_edit_panel } from "./edit_panel.js";
import { make_job_list } from "./job_list.js";
import { make_job_panel } from "./job_panel.js";
import { make_job_view, points_of, take_event } from "./job_view.js";
import { make_player } from "./player.js";
import { make_strip } from "./strip.js";

const element = (id) => document.getElementById(id);

const said = {
  connected: "connected", waiting: "connection lost, trying again", ended: "job has ended", lost: "cannot follow this job",
};

function show_connection(state) {
  element("connection").textContent = said[state];
  element("connection").dataset.state = state === "ended" ? "connected" : state;
}

/** A problem in words, or null once all is well again. */
function show_problem(problem) {
  element("message").hidden = !problem;
  element("message").textContent = problem ? problem.message : "";
  if (problem?.status === 401) element("access").hidden = false;
}

let view = null;
let followed = null;  // aborts the job followed before

const strip = make_strip(element("strip"), (frame) => player.choose(frame));
const player = make_player(
  {
    canvas: element("picture"), wipe: element("wipe"), compare: element("compare"), other_job: element("other-job"),
    other_frame: element("other-frame"), play: element("play"), frame: element("frame"),
  },
  (frame) => strip.show(view, frame),
  show_problem,
);
const panel = make_job_panel({ facts: element("facts"), controls: element("controls"), on_step: choose_job, on_problem: show_problem });
const edit_panel = make_edit_panel({
  form: element("edit"), on_problem: show_problem,
  // The events of a job that had ended have ended too.
  on_edited: (job, before) => before.ended && view?.job.id === job.id && choose_job(job.id),
});
// Nothing waits for the chart's library: a form that nobody listens to yet would be sent the browser's way.
let chart = null;
make_chart(element("chart"), (frame) => player.choose(frame)).then((made) => {
  chart = made;
  if (view) show_soon();
});

// Events come faster than a screen is drawn: what they changed is shown once a screen.
let is_due = false;
function show_soon() {
  if (is_due) return;
  is_due = true;
  requestAnimationFrame(() => {
    is_due = false;
    if (!view) return;
    player.show(view);
    strip.show(view, player.frame());
    panel.show(view.job);
    edit_panel.show(view.job);
    chart?.show(view.points);
  });
}

/** What was not watched: how near the finished frames of a job that has ended came, and when. */
async function show_history(id) {
  const { frames } = await get_json(`/v1/jobs/${id}/convergence`).catch(() => ({ frames: [] }));
  if (view?.job.id !== id || view.points.length) return;
  view.points = points_of(frames);
  show_soon();
}

async function choose_job(id) {
  followed?.abort();
  followed = new AbortController();
  history.replaceState(null, "", `#${id}`);
  jobs.choose(id);
  view = null;
  try {
    await follow(id, {
      signal: followed.signal,
      on_connection: show_connection,
      on_event(name, data) {
        view = view ? take_event(view, name, data, performance.now() / 1000) : make_job_view(data);
        if (name === "job") jobs.refresh();
        if (name === "snapshot" && data.ended) show_history(id);
        show_soon();
      },
    });
  } catch (problem) {
    show_connection("lost");
    show_problem(problem);
  }
}

const jobs = make_job_list({
  list: element("jobs"), form: element("submit"), on_choose: choose_job, on_problem: show_problem,
  on_jobs(all) {
    const before = element("other-job").value;
    element("other-job").replaceChildren(...all.map((job) => new Option(`${job.id} ${job.settings.method ?? ""}`, job.id)));
    if (before) element("other-job").value = before;
    // Whoever opens the page sees something at once.
    if (!followed && all.length) choose_job(location.hash.slice(1) || all[0].id);
  },
});

element("access").addEventListener("submit", (event) => {
  event.preventDefault();
  set_token(new FormData(event.target).get("token"));
  show_problem(null);
  if (location.hash) choose_job(location.hash.slice(1));
});
element("previous").addEventListener("click", () => player.step(-1));
element("next").addEventListener("click", () => player.step(1));
addEventListener("keydown", (event) => {
  // Fields and buttons keep their own keys.
  if (/^(INPUT|SELECT|BUTTON)$/.test(event.target.tagName) || event.target.id === "strip") return;
  if (event.key === "ArrowLeft") player.step(-1);
  else if (event.key === "ArrowRight") player.step(1);
  else if (event.key === " ") element("play").click();
  else return;
  event.preventDefault();
});
