#include "service/api/routes.h"
#include "service/api/scene_files.h"
#include "service/base/option_values.h"

namespace afterglow {

namespace {

SceneFormat format_of_body(const Request& request) {
    const std::string type = request.media_type();
    if (type == "model/gltf-binary") return SceneFormat::glb;
    if (type == "model/gltf+json") return SceneFormat::gltf;
    if (type == "model/obj") return SceneFormat::obj;
    if (type == "application/json") return SceneFormat::json;
    throw ProblemError(
        {415, "unsupported_media_type",
         "scenes are model/gltf-binary, model/gltf+json, model/obj, application/json, application/zip, "
         "multipart/form-data or application/vnd.afterglow.files+json",
         "Content-Type"});
}

UpAxis read_up(const std::string& text) {
    if (text == "y") return UpAxis::y;
    if (text == "z") return UpAxis::z;
    throw Error(ErrorKind::invalid_input, "request?obj_up", "expected y or z");
}

SceneUpload read_upload(const Request& request) {
    for (const auto& [name, value] : request.query)
        if (name != "name" && name != "obj_unit_m" && name != "obj_up" && name != "main")
            throw Error(ErrorKind::invalid_input, "request?" + name, "unknown parameter");
    SceneUpload upload;
    upload.format = holds_files(request) ? SceneFormat::bundle : format_of_body(request);
    upload.name = request.parameter("name");
    if (upload.name.empty()) upload.name = "scene";
    if (upload.name.size() > 200)
        throw Error(ErrorKind::invalid_input, "request?name", "longer than 200 bytes");
    if (const auto unit = request.parameter("obj_unit_m"); !unit.empty())
        upload.load.obj_unit_m = decimal_number("request?obj_unit_m", unit, 1e-6, 1e6);
    if (const auto up = request.parameter("obj_up"); !up.empty()) upload.load.obj_up = read_up(up);
    return upload;
}

std::size_t bytes_of(const Request& request) {
    std::size_t bytes = request.body.size();
    for (const FormPart& part : request.parts) bytes += part.body.size();
    return bytes;
}

Reply post_scene(const RouteContext& context, const Request& request) {
    SceneUpload upload = read_upload(request);
    context.usage.take_bytes(request.client, bytes_of(request));
    PackedScene packed;
    if (upload.format == SceneFormat::bundle) {
        packed = read_scene_files(request, context.blobs, context.limits, context.unpack);
        upload.format = packed.format;
    }
    const std::string& bytes = packed.bytes.empty() ? request.body : packed.bytes;
    const auto added =
        context.scenes.add(bytes, upload, static_cast<std::uint64_t>(request.client.quota.triangles));
    return json_reply(to_json(added.scene), added.outcome == SceneStore::Added::Outcome::created ? 201 : 200);
}

Reply post_paths(const RouteContext& context, const Request& request) {
    json_body(request, context.limits.document_bytes);
    context.usage.take_bytes(request.client, request.body.size());
    return json_reply({{"id", context.scenes.add_paths(request.body)}}, 201);
}

}  // namespace

void add_scene_routes(Router& router, const RouteContext& context) {
    router.add("POST", "/v1/scenes",
               [context](const Request& request, const PathValues&) { return post_scene(context, request); });
    router.add("POST", "/v1/paths",
               [context](const Request& request, const PathValues&) { return post_paths(context, request); });
}

}  // namespace afterglow
