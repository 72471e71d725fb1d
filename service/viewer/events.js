// A job's server-sent events, across interruptions. EventSource would do, but it can send no token.

import { ProblemError, request } from "./api.js";

/** The events of a text/event-stream, from its decoded pieces: {id, name, data}. Source: WHATWG HTML 9.2.6. */
export async function* parse_events(pieces) {
  let rest = "";
  let event = { id: "", name: "message", data: [] };
  for await (const piece of pieces) {
    const lines = (rest + piece).split(/\r\n|\n|\r(?!$)/);
    rest = lines.pop();
    for (const line of lines) {
      if (line === "") {
        if (event.data.length) yield { ...event, data: event.data.join("\n") };
        event = { id: event.id, name: "message", data: [] };
        continue;
      }
      const colon = line.indexOf(":");
      const field = colon < 0 ? line : line.slice(0, colon);
      const value = colon < 0 ? "" : line.slice(colon + 1).replace(/^ /, "");
      if (field === "id") event.id = value;
      else if (field === "event") event.name = value;
      else if (field === "data") event.data.push(value);
    }
  }
}

async function* decoded(body) {
  const decoder = new TextDecoder();
  const reader = body.getReader();
  try {
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      yield decoder.decode(value, { stream: true });
    }
  } finally {
    reader.cancel().catch(() => {});
  }
}

function sleep(milliseconds, signal) {
  return new Promise((resolve) => {
    const timer = setTimeout(resolve, milliseconds);
    signal.addEventListener("abort", () => (clearTimeout(timer), resolve()), { once: true });
  });
}

const first_wait_ms = 250;
const longest_wait_ms = 8000;

/**
 * Tells `on_event(name, data)` what happens to a job until it ends or `signal` is aborted, and `on_connection(state)` how the
 * connection stands: "connected", "waiting" between attempts, "ended". Goes on where it was cut off; where the service has
 * forgotten that place, it sends a snapshot. Errors: what no further attempt would mend (an unknown job, a missing token).
 */
export async function follow(job, { on_event, on_connection, signal }) {
  let last_id = "";
  let wait = first_wait_ms;
  while (!signal.aborted) {
    try {
      const headers = last_id ? { "Last-Event-ID": last_id } : {};
      const response = await request("GET", `/v1/jobs/${job}/events`, { headers, signal });
      on_connection("connected");
      for await (const event of parse_events(decoded(response.body))) {
        wait = first_wait_ms;
        last_id = event.id;
        on_event(event.name, JSON.parse(event.data));
        if (event.name === "end") return on_connection("ended");
      }
    } catch (failure) {
      if (signal.aborted) return;
      if (failure instanceof ProblemError && failure.status === 410) last_id = "";
      else if (failure instanceof ProblemError && [401, 403, 404].includes(failure.status)) throw failure;
    }
    on_connection("waiting");
    await sleep(wait, signal);
    wait = Math.min(wait * 2, longest_wait_ms);
  }
}
