"""Replies of the real service, good ones and typical problems, against its openapi.json. AFTERGLOWD names the program."""

import hashlib
import io
import json
import tempfile
import unittest
import zipfile

import jsonschema

from service_under_description import METHODS, DescribedService, data_file, events_of, expanded

JSON = {"Content-Type": "application/json"}
GLB = {"Content-Type": "model/gltf-binary"}
SMALL = {"frames": "0-1", "width": 32, "height": 24, "rays": 16, "patch_size_m": 0.6, "quality": "draft", "error": 0.2}
LAMP = """{"afterglow": 1, "materials": [{"name": "lamp", "emission": 5}],
 "nodes": [{"name": "lamp", "geometry": {"quad": {"size": [1, 1]}, "material": "lamp"}}]}"""
TOKENS = """anna submitter annas-token-16-bytes jobs=1 bytes=300000 streams=1 frames=1000 pixels=4000
bert submitter berts-token-16-bytes
vera viewer veras-token-16-bytes
"""


class Described(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = DescribedService()
        cls.addClassCleanup(cls.service.stop)

    def ask(self, *arguments, **more):
        return self.service.ask(*arguments, **more)

    def upload(self, **more):
        reply = self.service.plain("POST", "/v1/scenes?name=room.glb", data_file("cornell-slide.glb"), GLB | more)
        self.assertIn(reply.status, (200, 201), reply.body)
        return reply.json()["id"]

    def submit(self, *, headers=None, status=201, **settings):
        body = json.dumps({"scene": self.upload(**(headers or {})), "settings": SMALL | settings})
        return self.ask(status, "POST", "/v1/jobs", body, JSON | (headers or {})).json().get("id")

    def endless(self, **more):
        return self.submit(frames="0-900", width=48, height=48, rays=64, patch_size_m=0.1, error=0.001, **more)


class Document(Described):
    def test_every_schema_is_one(self):
        def visit(value):
            if isinstance(value, dict):
                if isinstance(value.get("schema"), dict):
                    jsonschema.Draft202012Validator.check_schema(expanded(value["schema"], document))
                for one in value.values():
                    visit(one)
            elif isinstance(value, list):
                for one in value:
                    visit(one)

        document = self.service.document
        for name, schema in document["components"]["schemas"].items():
            jsonschema.Draft202012Validator.check_schema(expanded(schema, document))
        visit(document)

    def test_what_is_not_described_is_noticed(self):
        with self.assertRaises(jsonschema.ValidationError):
            self.service.fits({"status": "ok", "more": 1}, {"$ref": "#/components/schemas/Status"})
        with self.assertRaises(jsonschema.ValidationError):
            self.service.fits({"status": "fine"}, {"$ref": "#/components/schemas/Status"})

    def test_other_methods_name_the_described_ones(self):
        for path, item in self.service.document["paths"].items():
            address = path.replace("{", "").replace("}", "")
            reply = self.service.plain("TRACE", address)
            self.assertEqual(reply.status, 405, path)
            self.service.fits(reply.json(), {"$ref": "#/components/schemas/Problem"})
            allowed = {name.strip().lower() for name in reply.headers["allow"].split(",")}
            described = {method for method in METHODS if method in item}
            self.assertEqual(allowed, described | ({"head"} if "get" in described else set()), path)


class EveryOperation(Described):
    def test_each_replies_as_described(self):
        self.status_and_page()
        self.scenes()
        self.jobs()
        self.ended_job()
        self.problems_of_jobs()
        described = {(method.upper(), path) for path, item in self.service.document["paths"].items()
                     for method in METHODS if method in item}
        succeeded = {(method, path) for method, path, status in self.service.seen if status < 300}
        self.assertEqual(succeeded, described, "operations without a good reply")

    def status_and_page(self):
        for address in ("/", "/viewer/main.js", "/viewer/style.css", "/healthz", "/readyz", "/metrics",
                        "/v1/openapi.json"):
            reply = self.ask(200, "GET", address)
            if "etag" in reply.headers:
                self.ask(304, "GET", address, headers={"If-None-Match": reply.headers["etag"]})
        self.ask(404, "GET", "/viewer/nothing.js")

    def scenes(self):
        glb = data_file("cornell-slide.glb")
        scene = self.ask(201, "POST", "/v1/scenes?name=room.glb", glb, GLB).json()
        self.assertEqual(scene["name"], "room.glb")
        self.assertEqual(self.ask(200, "POST", "/v1/scenes?name=room.glb", glb, GLB).json(), scene)
        self.ask(201, "POST", "/v1/scenes", LAMP, JSON)
        self.ask(422, "POST", "/v1/scenes", data_file("examples/study.json"), JSON)  # refers to other files
        self.ask(415, "POST", "/v1/scenes", glb, {"Content-Type": "text/plain"})
        self.ask(422, "POST", "/v1/scenes", b"no scene", GLB)
        self.ask(422, "POST", "/v1/scenes?name=" + "n" * 201, glb, GLB)
        self.ask(422, "POST", "/v1/scenes?obj_up=x", glb, GLB)
        self.several_files()
        self.ask(201, "POST", "/v1/paths", data_file("examples/study-paths.json"), JSON)
        self.ask(400, "POST", "/v1/paths", "{", JSON)
        self.ask(415, "POST", "/v1/paths", "{}", {"Content-Type": "text/xml"})
        self.ask(422, "POST", "/v1/paths", "[]", JSON)

    def several_files(self):
        files = {name: data_file("examples/" + name) for name in ("study.json", "chair.obj", "chair.mtl")}
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in files.items():
                archive.writestr("study/" + name, content)
        zipped = {"Content-Type": "application/zip"}
        # Both .json and .obj can be scenes.
        self.ask(422, "POST", "/v1/scenes", packed.getvalue(), zipped)
        scene = self.ask(201, "POST", "/v1/scenes?main=study/study.json", packed.getvalue(), zipped).json()
        form = b"".join(b'--b\r\nContent-Disposition: form-data; name="files"; filename="study/%s"\r\n\r\n%s\r\n'
                        % (name.encode(), content) for name, content in files.items()) + b"--b--\r\n"
        in_form = {"Content-Type": "multipart/form-data; boundary=b"}
        self.assertEqual(self.ask(200, "POST", "/v1/scenes?main=study/study.json", form, in_form).json(), scene)
        listed = {"Content-Type": "application/vnd.afterglow.files+json"}
        hashes = {name: hashlib.sha256(content).hexdigest() for name, content in files.items()}
        manifest = {"main": "study/study.json", "files": {"study/" + name: {"sha256": hashes[name]} for name in files}}
        self.service.fits(manifest, {"$ref": "#/components/schemas/FileList"})
        self.ask(422, "POST", "/v1/scenes", json.dumps(manifest), listed)
        for name, content in files.items():
            address = "/v1/blobs/" + hashes[name]
            self.ask(404, "HEAD", address)
            self.ask(422, "PUT", address, content + b"!")
            self.ask(201, "PUT", address, content)
            self.ask(200, "PUT", address, content)
            self.ask(200, "HEAD", address)
        self.ask(422, "HEAD", "/v1/blobs/short")
        self.ask(422, "PUT", "/v1/blobs/short", b"")
        self.ask(415, "PUT", "/v1/blobs/" + hashes["study.json"], form, in_form)
        self.assertEqual(self.ask(200, "POST", "/v1/scenes", json.dumps(manifest), listed).json(), scene)
        self.ask(400, "POST", "/v1/scenes", "{", listed)
        self.ask(422, "POST", "/v1/scenes", packed.getvalue()[:-30], zipped)

    def jobs(self):
        id = self.endless()
        self.ask(425, "GET", f"/v1/jobs/{id}/frames/900/image")
        self.ask(409, "POST", f"/v1/jobs/{id}/resume")
        patch = {"Content-Type": "application/merge-patch+json"}
        for body, priority in (('{"priority": 7}', 7), ("{}", 7), ('{"priority": null}', 0)):
            self.assertEqual(self.ask(200, "PATCH", f"/v1/jobs/{id}", body, patch).json()["priority"], priority)
        for body in ('{"priority": 11}', '{"priority": "1"}', '{"state": "paused"}', "[]"):
            self.ask(422, "PATCH", f"/v1/jobs/{id}", body, patch)
        self.ask(400, "PATCH", f"/v1/jobs/{id}", "{", patch)
        self.ask(415, "PATCH", f"/v1/jobs/{id}", "{}", JSON)
        self.ask(409, "DELETE", f"/v1/jobs/{id}")
        self.ask(200, "POST", f"/v1/jobs/{id}/pause")
        self.ask(409, "POST", f"/v1/jobs/{id}/pause")
        self.ask(200, "POST", f"/v1/jobs/{id}/resume")
        self.ask(200, "POST", f"/v1/jobs/{id}/cancel")
        self.ask(409, "POST", f"/v1/jobs/{id}/cancel")
        self.ask(409, "PATCH", f"/v1/jobs/{id}", '{"priority": 1}', patch)
        self.ask(200, "POST", f"/v1/jobs/{id}/retry")
        self.ask(409, "POST", f"/v1/jobs/{id}/retry")
        self.ask(200, "POST", f"/v1/jobs/{id}/cancel")
        page = self.ask(200, "GET", "/v1/jobs?state=cancelled&limit=1").json()
        self.assertEqual([job["id"] for job in page["jobs"]], [id])
        self.ask(200, "DELETE", f"/v1/jobs/{id}?dry_run=1")
        self.ask(422, "DELETE", f"/v1/jobs/{id}?dry_run=x")
        self.ask(200, "DELETE", f"/v1/jobs/{id}")
        self.ask(410, "GET", f"/v1/jobs?cursor={id}")

    def ended_job(self):
        id = self.submit(estimate="probes")
        events = events_of(self.ask(200, "GET", f"/v1/jobs/{id}/events", headers={"Last-Event-ID": "0"}))
        self.assertEqual(events[-1]["data"], {"state": "succeeded"})
        self.assertLessEqual({"job", "image", "end"}, {event["event"] for event in events})
        replayed, lines = (events_of(self.ask(200, "GET", f"/v1/jobs/{id}/events", headers={"Last-Event-ID": "0"} | more))
                           for more in ({}, {"Accept": "application/x-ndjson"}))
        self.assertEqual(replayed, lines)
        opened = events_of(self.ask(200, "GET", f"/v1/jobs/{id}/events"))
        self.assertEqual([event["event"] for event in opened], ["snapshot", "end"])
        self.ask(410, "GET", f"/v1/jobs/{id}/events?last_event_id=1000000")
        self.ask(422, "GET", f"/v1/jobs/{id}/events", headers={"Last-Event-ID": "x"})
        self.ask(200, "GET", f"/v1/jobs/{id}/live")
        self.assertEqual(self.ask(200, "GET", f"/v1/jobs/{id}?wait=1").json()["state"], "succeeded")
        self.ask(422, "GET", f"/v1/jobs/{id}?wait=61")
        self.ask(200, "GET", f"/v1/jobs/{id}/convergence")
        self.edits(id)
        csv = self.ask(200, "GET", f"/v1/jobs/{id}/convergence?type=csv").body.decode().splitlines()
        self.assertEqual((csv[0], len(csv)), ("frame,seconds,residual,error_bound,picture_error", 3))
        self.ask(422, "GET", f"/v1/jobs/{id}/convergence?type=xml")
        frames = self.ask(200, "GET", f"/v1/jobs/{id}/frames").json()["frames"]
        self.assertEqual([frame["final"] for frame in frames], [True, True])
        for address in (frames[0]["png"], frames[1]["exr"], f"/v1/jobs/{id}/frames/1/image"):
            tag = self.ask(200, "GET", address).headers["etag"]
            self.ask(304, "GET", address, headers={"If-None-Match": tag})
        self.ask(410, "GET", f"/v1/jobs/{id}/frames/0/image?rev=1")
        self.ask(404, "GET", f"/v1/jobs/{id}/frames/2/image")
        self.ask(422, "GET", f"/v1/jobs/{id}/frames/0/image?type=gif")

    def edits(self, id):
        address = f"/v1/jobs/{id}/edits"
        editable = self.ask(200, "GET", f"/v1/jobs/{id}/editable").json()
        lamp = next(one for one in editable["materials"] if one["emission_scale"])
        body = json.dumps({"edits": [{"light": {"material": lamp["material"], "emission_scale": 0.5}},
                                     {"light": {"name": lamp["material"], "scale": 0.5}}]})
        self.service.fits(json.loads(body), {"$ref": "#/components/schemas/NewEdits"})
        tag = self.ask(200, "GET", f"/v1/jobs/{id}").headers["etag"]
        self.ask(428, "POST", address, body, JSON)
        self.ask(412, "POST", address, body, JSON | {"If-Match": '"7"'})
        self.ask(422, "POST", address, '{"edits": []}', JSON | {"If-Match": tag})
        self.ask(415, "POST", address, body, {"Content-Type": "text/plain", "If-Match": tag})
        self.assertEqual(self.ask(200, "POST", address, body, JSON | {"If-Match": tag}).json()["revision"], 1)
        events = events_of(self.ask(200, "GET", f"/v1/jobs/{id}/events", headers={"Last-Event-ID": "0"}))
        self.assertIn("edit", {event["event"] for event in events})
        self.assertEqual(self.ask(200, "GET", address).json()["revision"], 1)

    def problems_of_jobs(self):
        scene = self.upload()
        self.ask(400, "POST", "/v1/jobs", "{", JSON)
        self.ask(413, "POST", "/v1/jobs", b" " * (2 << 20), JSON)
        self.ask(415, "POST", "/v1/jobs", "{}", {"Content-Type": "text/plain"})
        self.ask(422, "POST", "/v1/jobs", '{"scene": "unknown"}', JSON)
        self.ask(422, "POST", "/v1/jobs", json.dumps({"scene": scene, "settings": {"rays": 1}}), JSON)
        key = JSON | {"Idempotency-Key": "key"}
        body = json.dumps({"scene": scene, "settings": SMALL})
        first = self.ask(201, "POST", "/v1/jobs", body, key).json()["id"]
        self.assertEqual(self.ask(201, "POST", "/v1/jobs", body, key).json()["id"], first)
        self.ask(422, "POST", "/v1/jobs", body + " ", key)
        self.ask(200, "GET", "/v1/jobs?limit=1")
        self.ask(422, "GET", "/v1/jobs?limit=0")
        self.ask(422, "GET", "/v1/jobs?state=busy")
        self.ask(415, "POST", "/v1/jobs", "{}", JSON | {"Content-Encoding": "gzip"})
        self.ask(421, "GET", "/v1/jobs", headers={"Host": "elsewhere.example"})
        self.ask(403, "GET", "/v1/jobs", headers={"Origin": "http://elsewhere.example"})
        self.ask(404, "PATCH", "/v1/jobs/unknown", "{}", {"Content-Type": "application/merge-patch+json"})
        for method, rest in (("GET", ""), ("DELETE", ""), ("POST", "/cancel"), ("POST", "/pause"), ("POST", "/resume"),
                             ("POST", "/retry"), ("GET", "/edits"), ("GET", "/editable"), ("GET", "/frames"), ("GET", "/convergence"), ("GET", "/frames/0/image"),
                             ("GET", "/events"), ("GET", "/live")):
            self.ask(404, method, "/v1/jobs/unknown" + rest)


class WithTokens(Described):
    @classmethod
    def setUpClass(cls):
        with tempfile.NamedTemporaryFile("w", suffix=".tokens") as file:
            file.write(TOKENS)
            file.flush()
            cls.service = DescribedService("--token-file", file.name,
                                           headers={"Authorization": "Bearer berts-token-16-bytes"})
        cls.addClassCleanup(cls.service.stop)

    anna = {"Authorization": "Bearer annas-token-16-bytes"}
    vera = {"Authorization": "Bearer veras-token-16-bytes"}

    def test_who_may_what(self):
        self.ask(401, "GET", "/v1/jobs", headers={"Authorization": "Bearer wrong"})
        self.ask(200, "GET", "/healthz", headers={"Authorization": ""})
        self.ask(200, "GET", "/v1/jobs", headers=self.vera)
        self.ask(403, "POST", "/v1/paths", "{}", JSON | self.vera)
        job = self.endless(headers=self.anna)
        for method, rest in (("DELETE", ""), ("POST", "/cancel"), ("POST", "/pause"), ("POST", "/resume"),
                             ("POST", "/retry")):
            self.ask(403, method, f"/v1/jobs/{job}{rest}")
        self.ask(403, "PATCH", f"/v1/jobs/{job}", "{}", {"Content-Type": "application/merge-patch+json"})
        self.submit(headers=self.anna, status=429)
        self.ask(200, "POST", f"/v1/jobs/{job}/cancel", headers=self.anna)
        self.submit(headers=self.anna, status=413, width=100, height=100)
        self.ask(429, "POST", "/v1/paths", json.dumps({"padding": " " * 300_000}), JSON | self.anna)


if __name__ == "__main__":
    unittest.main()
