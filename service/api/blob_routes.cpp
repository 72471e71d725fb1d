#include "service/api/routes.h"
#include "service/api/scene_files.h"
#include "service/base/identity.h"

namespace afterglow {

namespace {

void check_name(const std::string& name) {
    if (!BlobStore::is_name(name))
        throw Error(ErrorKind::invalid_input, "sha256", "expected 64 digits of lower-case hexadecimal");
}

Reply put_blob(const RouteContext& context, const Request& request, const std::string& name) {
    check_name(name);
    if (request.media_type() == form_type)
        throw ProblemError(
            {415, "unsupported_media_type", "a blob is the body itself, no form", "Content-Type"});
    if (request.body.size() > context.limits.upload_bytes)
        throw Error(ErrorKind::too_large, "body",
                    "longer than " + std::to_string(context.limits.upload_bytes) + " bytes");
    if (sha256(request.body) != name)
        throw ProblemError({422, "hash_mismatch", "the body has another SHA-256", "body"});
    const Json about = {{"sha256", name}, {"bytes", request.body.size()}};
    if (context.blobs.has(name)) return json_reply(about);
    context.usage.take_bytes(request.client, request.body.size());
    return json_reply(about, context.blobs.put(name, request.body) ? 201 : 200);
}

Reply head_blob(const RouteContext& context, const std::string& name) {
    check_name(name);
    if (!context.blobs.has(name)) throw ProblemError({404, "not_found", "there is no such blob", name});
    return {200, "", "", {{"Cache-Control", "no-store"}}, nullptr};
}

}  // namespace

void add_blob_routes(Router& router, const RouteContext& context) {
    router.add("PUT", "/v1/blobs/{}", [context](const Request& request, const PathValues& values) {
        return put_blob(context, request, values[0]);
    });
    router.add("HEAD", "/v1/blobs/{}",
               [context](const Request&, const PathValues& values) { return head_blob(context, values[0]); });
}

}  // namespace afterglow
