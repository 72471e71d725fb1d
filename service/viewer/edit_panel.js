// Edits of the chosen job: an object is moved, a lamp dimmed. Each is sent as soon as it is made, and what is shown follows.

import { get_json, post_json } from "./api.js";
import { percent } from "./job_view.js";

/** The edit that a form's values ask for, as in the service's interface; null where it changes nothing. */
export function move_of(node, translation) {
  return translation.some((metres) => metres !== 0) ? { move: { node, translation } } : null;
}

export function dim_of({ kind, name }, percent_of_scene) {
  const scale = percent_of_scene / 100;
  return { light: kind === "lamp" ? { lamp: name, intensity_scale: scale } : { material: name, emission_scale: scale } };
}

/**
 * Lamps of a reply of `/editable`: what gives light in the scene as it was uploaded, materials and lights without surface. `label` tells
 * apart what shares a name.
 */
export function lamps_of(editable) {
  const materials = editable.materials.map((m) => ({ kind: "material", name: m.material, scale: m.emission_scale }));
  const lamps = editable.lamps.map((l) => ({ kind: "lamp", name: l.lamp, scale: l.intensity_scale }));
  const shining = [...materials, ...lamps].filter((lamp) => lamp.scale !== null);
  const is_alone = (lamp) => shining.filter((other) => other.name === lamp.name).length === 1;
  return shining.map((lamp) => ({ ...lamp, label: is_alone(lamp) ? lamp.name : `${lamp.name} (${lamp.kind})` }));
}

/** What became of a job's newest edit, in words. */
export function said_of(job) {
  if (!job.revision) return "";
  const edits = `${job.revision} ${job.revision === 1 ? "edit" : "edits"}`;
  if (job.reused == null) return `${edits}; the newest is being taken over`;
  return `${edits}; the newest kept ${percent(job.reused)} of all lines`;
}

function fill(select, names) {
  const before = select.value;
  select.replaceChildren(...names.map((name) => new Option(name, name)));
  if (names.includes(before)) select.value = before;
}

/**
 * `form` has fields object, x, y, z, lamp, dim and outputs dimmed, said. `on_edited(job)` hears of every edit that was accepted.
 */
export function make_edit_panel({ form, on_edited, on_problem }) {
  const field = (name) => form.elements[name];
  let job = null;
  let editable = null;
  let sending = null;  // the edit on its way, and the newest one that waits for it

  const show_dim = () => {
    field("dimmed").value = `${field("dim").value} % of what it is in the scene`;
  };

  const chosen_lamp = () => editable && lamps_of(editable).find((lamp) => lamp.label === field("lamp").value);

  const show_lamp = () => {
    const lamp = chosen_lamp();
    if (lamp) field("dim").value = Math.round(100 * lamp.scale);
    show_dim();
  };

  const load = async (id) => {
    const fresh = await get_json(`/v1/jobs/${id}/editable`);
    if (job?.id !== id) return;
    editable = fresh;
    fill(field("object"), fresh.objects.map((o) => o.node));
    fill(field("lamp"), lamps_of(fresh).map((lamp) => lamp.label));
    show_lamp();
    form.hidden = false;
  };

  const send = async (edit) => {
    if (sending) return void (sending.next = edit);
    sending = { next: edit };
    while (sending.next) {
      const edits = [sending.next];
      sending.next = null;
      try {
        const edited = await post_json(`/v1/jobs/${job.id}/edits`, { edits }, { "If-Match": `"${job.revision}"` });
        on_problem(null);
        const before = job;
        if (job.id === edited.id) job = edited;
        on_edited(edited, before);
      } catch (problem) {
        on_problem(problem);
        // Somebody else edited it: what is shown is what it is now.
        if (problem.status === 412) job = await get_json(`/v1/jobs/${job.id}`).catch(() => job);
        await load(job.id).catch(on_problem);
      }
    }
    sending = null;
  };

  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const edit = move_of(field("object").value, ["x", "y", "z"].map((axis) => Number(field(axis).value)));
    if (edit) send(edit);
  });
  field("lamp").addEventListener("change", show_lamp);
  field("dim").addEventListener("input", show_dim);
  field("dim").addEventListener("change", () => {
    const lamp = chosen_lamp();
    if (lamp) send(dim_of(lamp, Number(field("dim").value)));
  });

  return {
    /** Takes over a job as it is now. */
    show(now) {
      const is_new = job?.id !== now.id;
      // An event may be older than the reply to an edit.
      if (is_new || now.revision >= job.revision) job = now;
      const said = said_of(job);
      if (field("said").value !== said) field("said").value = said;
      field("edits").disabled = job.state === "cancelled";
      if (!is_new) return;
      form.hidden = true;
      load(job.id).catch(on_problem);
    },
  };
}
