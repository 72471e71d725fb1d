// Requests to the service. Failures arrive as ProblemError, whatever went wrong.

/** What the service, or the way to it, refused: RFC 9457 where it came from the service; status 0 where nothing answered. */
export class ProblemError extends Error {
  constructor({ status = 0, code = "no_answer", detail = "the service does not answer", place = "" }) {
    super(place ? `${place}: ${detail}` : detail);
    Object.assign(this, { status, code, detail, place });
  }
}

const token_key = "afterglow.token";

export function token() {
  return sessionStorage.getItem(token_key) ?? "";
}

export function set_token(value) {
  sessionStorage.setItem(token_key, value);
}

/** The response to a request; throws ProblemError unless it succeeded. */
export async function request(method, path, { body, headers = {}, signal } = {}) {
  const all = { ...headers };
  if (token()) all.Authorization = `Bearer ${token()}`;
  let response;
  try {
    response = await fetch(path, { method, headers: all, body, signal });
  } catch (failure) {
    if (failure.name === "AbortError") throw failure;
    throw new ProblemError({});
  }
  if (response.ok) return response;
  const problem = await response.json().catch(() => ({}));
  throw new ProblemError({ code: "unexpected", detail: response.statusText, ...problem, status: response.status });
}

export async function get_json(path) {
  return (await request("GET", path)).json();
}

export async function post_json(path, value = {}, headers = {}) {
  const response = await request("POST", path, {
    body: JSON.stringify(value),
    headers: { "Content-Type": "application/json", ...headers },
  });
  return response.json();
}

const type_of_extension = {
  glb: "model/gltf-binary", gltf: "model/gltf+json", obj: "model/obj", json: "application/json", zip: "application/zip",
};

/** Uploads a scene file and returns what the service says of it. */
export async function upload_scene(file) {
  const extension = file.name.split(".").pop().toLowerCase();
  const type = type_of_extension[extension];
  if (!type) throw new ProblemError({ detail: "expected a .glb, .gltf, .obj or .json file, or a .zip with all that belongs to it", place: file.name });
  const path = `/v1/scenes?name=${encodeURIComponent(file.name)}`;
  return (await request("POST", path, { body: file, headers: { "Content-Type": type } })).json();
}

/** A picture ready to be drawn; close() it when it is not needed any more. */
export async function get_picture(url, signal) {
  return createImageBitmap(await (await request("GET", url, { signal })).blob());
}
