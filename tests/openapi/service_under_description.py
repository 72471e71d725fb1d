"""A running service each of whose replies is held against its own openapi.json."""

import http.client
import json
import os
import re
import subprocess
import tempfile
from pathlib import Path

import jsonschema

METHODS = ("get", "put", "post", "delete", "patch", "head")


def expanded(schema, document, part_of_another=False):
    """The schema without references, in which no object may have members that are not described."""
    if isinstance(schema, list):
        return [expanded(one, document) for one in schema]
    if not isinstance(schema, dict):
        return schema
    if "$ref" in schema:
        found = document
        for key in schema["$ref"].removeprefix("#/").split("/"):
            found = found[key]
        return expanded(found, document, part_of_another)
    out = {key: [expanded(one, document, True) for one in value] if key == "allOf" else expanded(value, document)
           for key, value in schema.items() if key != "x-item-schema"}
    described = "allOf" in schema or isinstance(schema.get("properties"), dict)
    if described and not part_of_another and "additionalProperties" not in schema:
        out["unevaluatedProperties"] = False
    return out


class Reply:
    def __init__(self, reply):
        self.status = reply.status
        self.headers = {name.lower(): value for name, value in reply.getheaders()}
        self.body = reply.read()

    @property
    def media_type(self):
        return self.headers.get("content-type", "").split(";")[0]

    def json(self):
        return json.loads(self.body)


class DescribedService:
    """Starts `afterglowd serve` (the program that AFTERGLOWD names) in a folder of its own."""

    def __init__(self, *arguments, headers=None):
        self.folder = tempfile.TemporaryDirectory(prefix="afterglow-openapi-")
        self.process = subprocess.Popen(
            [os.environ["AFTERGLOWD"], "serve", "--listen", "127.0.0.1:0", "--data", self.folder.name + "/data",
             *arguments], stdout=subprocess.PIPE, text=True)
        line = next(line for line in self.process.stdout if "listening on" in line)
        self.port = int(re.search(r":(\d+)\s*$", line)[1])
        self.headers = headers or {}  # of every request
        self.seen = set()  # (METHOD, path, status)
        self.document = self.plain("GET", "/v1/openapi.json").json()

    def stop(self):
        self.process.terminate()
        self.process.wait(60)
        self.process.stdout.close()
        self.folder.cleanup()

    def plain(self, method, address, body=None, headers=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        connection.request(method, address, body, self.headers | (headers or {}))
        reply = Reply(connection.getresponse())
        connection.close()
        return reply

    def operation(self, method, address):
        """Path and description of the operation that an address stands for."""
        wanted = address.split("?")[0].split("/")
        for path, item in self.document["paths"].items():
            parts = path.split("/")
            if len(parts) == len(wanted) and method.lower() in item and all(
                    part.startswith("{") or part == have for part, have in zip(parts, wanted)):
                return path, item[method.lower()]
        raise AssertionError(f"{method} {address} is not described")

    def ask(self, status, method, address, body=None, headers=None):
        """Sends a request whose reply must have the status and be as described; returns the reply."""
        path, operation = self.operation(method, address)
        reply = self.plain(method, address, body, headers)
        about = f"{method} {address}: {reply.status} {reply.body[:300]!r}"
        assert reply.status == status, about
        responses = operation["responses"]
        assert status >= 400 or str(status) in responses, about
        self.check(reply, responses.get(str(status), responses["default"]), about)
        self.seen.add((method, path, status))
        return reply

    def check(self, reply, response, about):
        if "$ref" in response:
            response = self.document["components"]["responses"][response["$ref"].split("/")[-1]]
        for name, header in response.get("headers", {}).items():
            header = expanded(header, self.document)
            value = reply.headers.get(name.lower())
            assert value is not None or not header.get("required"), f"{about}: no {name}"
            if value is not None:
                self.fits(int(value) if header["schema"].get("type") == "integer" else value, header["schema"])
        if reply.status == 304 or "content" not in response:
            assert reply.body == b"", about
            return
        assert reply.media_type in response["content"], f"{about}: {reply.media_type}"
        media = response["content"][reply.media_type]
        if reply.media_type.endswith("json") and "x-item-schema" not in media:
            self.fits(reply.json(), media["schema"])
        if reply.media_type == "application/problem+json":
            assert reply.json()["status"] == reply.status, about
        if "x-item-schema" in media:
            events = events_of(reply)
            assert events, about
            for event in events:
                self.fits(event, media["x-item-schema"])

    def fits(self, value, schema):
        jsonschema.Draft202012Validator(expanded(schema, self.document)).validate(value)


def events_of(reply):
    """The events of a stream that has ended, as {"event", "id", "data"}."""
    if reply.media_type == "application/x-ndjson":
        return [json.loads(line) for line in reply.body.splitlines() if line]
    events = []
    for block in reply.body.decode().split("\n\n"):
        fields = dict(line.split(": ", 1) for line in block.splitlines() if not line.startswith(":"))
        if fields:
            events.append({"event": fields["event"], "id": int(fields["id"]), "data": json.loads(fields["data"])})
    return events


def data_file(name):
    return (Path(__file__).resolve().parents[1] / "data" / name).read_bytes()
