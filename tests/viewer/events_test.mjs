import assert from "node:assert/strict";
import test from "node:test";

import { follow, parse_events } from "../../service/viewer/events.js";

globalThis.sessionStorage = { getItem: () => null, setItem: () => {} };

async function parsed(...pieces) {
  const events = [];
  for await (const event of parse_events(pieces)) events.push(event);
  return events;
}

test("events are the same wherever the stream is cut", async () => {
  const text = ": hello\n\nid: 1\nevent: image\ndata: {\"a\":\ndata: 1}\n\nid:2\r\nevent:end\r\ndata: {}\r\n\r\n";
  const whole = await parsed(text);
  assert.deepEqual(whole, [
    { id: "1", name: "image", data: "{\"a\":\n1}" },
    { id: "2", name: "end", data: "{}" },
  ]);
  for (let cut = 0; cut <= text.length; ++cut) assert.deepEqual(await parsed(text.slice(0, cut), text.slice(cut)), whole, `cut at ${cut}`);
});

test("an event that the end cuts off is not told", async () => {
  assert.deepEqual(await parsed("id: 1\ndata: x\n"), []);
});

const stream = (text, status = 200) => new Response(text, { status });

/** Follows a job whose service gives these replies, one a request; returns what was told and asked. */
async function followed(replies) {
  const told = [];
  const asked = [];
  globalThis.fetch = async (path, { headers }) => {
    asked.push(headers["Last-Event-ID"] ?? "");
    const reply = replies.shift();
    if (reply instanceof Error) throw reply;
    return reply;
  };
  const signal = new AbortController().signal;
  await follow("j", { signal, on_event: (name) => told.push(name), on_connection: (state) => told.push(`(${state})`) });
  return { told, asked };
}

test("a cut connection is taken up where it ended", async () => {
  const { told, asked } = await followed([
    stream("id: 7\nevent: image\ndata: {}\n\n"), new Error("refused"), stream("id: 8\nevent: end\ndata: {}\n\n"),
  ]);
  assert.deepEqual(asked, ["", "7", "7"]);
  assert.deepEqual(told, ["(connected)", "image", "(waiting)", "(waiting)", "(connected)", "end", "(ended)"]);
});

test("where the service has forgotten the place, it is asked for a snapshot", async () => {
  const { asked } = await followed([
    stream("id: 7\nevent: image\ndata: {}\n\n"), stream("{\"code\":\"gone\"}", 410), stream("id: 9\nevent: end\ndata: {}\n\n"),
  ]);
  assert.deepEqual(asked, ["", "7", ""]);
});

test("an unknown job is not asked for again", async () => {
  await assert.rejects(followed([stream("{\"code\":\"not_found\",\"detail\":\"no such job\"}", 404)]), { status: 404, message: "no such job" });
});
