#include "service/api/scene_files.h"

#include <filesystem>
#include <utility>

#include "service/base/zip_archive.h"
#include "solver/base/error.h"
#include "solver/scene/bundle.h"

namespace afterglow {

namespace {

bool can_be_scene(const std::string& name) {
    // macOS puts files of this kind beside the real ones.
    if (std::filesystem::path(name).filename().string().starts_with('.')) return false;
    try {
        format_of(name);
        return true;
    } catch (const Error&) {
        return false;
    }
}

void add_form(SceneFiles& files, const Request& request) {
    for (const FormPart& part : request.parts)
        files.add(part.file_name.empty() ? part.name : part.file_name, part.body, "form");
}

/// Returns the scene's name where the manifest gives one.
std::string add_blobs(SceneFiles& files, const Request& request, BlobStore& blobs, const Limits& limits) {
    constexpr const char* place = "manifest";
    if (request.body.size() > limits.request_bytes)
        throw Error(ErrorKind::too_large, place,
                    "longer than " + std::to_string(limits.request_bytes) + " bytes");
    Json manifest;
    try {
        manifest = parse_json(request.body, place);
    } catch (const Error& e) {
        throw ProblemError({400, "malformed_json", e.message(), e.place()});
    }
    const JsonView view(manifest, place);
    view.allow_only({"main", "files"});
    for (const auto& [name, file] : view.at("files").members()) {
        file.allow_only({"sha256"});
        const JsonView hash = file.at("sha256");
        if (!BlobStore::is_name(hash.as_string())) hash.fail("expected 64 digits of lower-case hexadecimal");
        auto content = blobs.get(hash.as_string());
        if (!content)
            throw Error(ErrorKind::not_found, hash.place(), "there is no such blob; upload it again");
        files.add(name, *std::move(content), place);
    }
    const auto main = view.find("main");
    return main ? main->as_string() : std::string();
}

}  // namespace

void SceneFiles::add(const std::string& name, std::string content, const std::string& place) {
    if (!is_plain_path(name))
        throw Error(ErrorKind::invalid_input, place, in_quotes(name) + " is no path inside the upload");
    if (files_.size() == limits_.scene_files)
        throw Error(ErrorKind::too_large, place,
                    "holds more than the limit of " + std::to_string(limits_.scene_files) + " files");
    if (content.size() > limits_.upload_bytes - bytes_)
        throw Error(ErrorKind::too_large, place,
                    "holds more than the limit of " + std::to_string(limits_.upload_bytes) + " bytes");
    bytes_ += content.size();
    if (!files_.emplace(name, std::move(content)).second)
        throw Error(ErrorKind::invalid_input, place, in_quotes(name) + " is there more than once");
}

std::string SceneFiles::choose(const std::string& main) const {
    if (!main.empty()) {
        if (!files_.contains(main))
            throw Error(ErrorKind::invalid_input, "main", in_quotes(main) + " is none of the files");
        return main;
    }
    std::string found;
    for (const auto& [name, content] : files_) {
        if (!can_be_scene(name)) continue;
        if (!found.empty())
            throw Error(ErrorKind::invalid_input, "main",
                        "say which is the scene, " + in_quotes(found) + " or " + in_quotes(name));
        found = name;
    }
    if (found.empty())
        throw Error(ErrorKind::invalid_input, "main", "no file ends in .glb, .gltf, .obj or .json");
    return found;
}

PackedScene SceneFiles::pack(const std::string& main) const {
    Bundle bundle{choose(main), {}};
    if (files_.size() == 1) return {files_.begin()->second, format_of(bundle.main)};
    for (const auto& [name, content] : files_) bundle.files.emplace(name, content);
    return {afterglow::pack(bundle), SceneFormat::bundle};
}

bool holds_files(const Request& request) {
    const std::string type = request.media_type();
    return type == zip_type || type == form_type || type == manifest_type;
}

PackedScene unpack_here(const std::string& archive, const std::string& main, const Limits& limits) {
    SceneFiles files(limits);
    for (auto& [name, content] : read_zip(archive, {limits.scene_files, limits.upload_bytes}, "archive"))
        files.add(name, std::move(content), "archive");
    return files.pack(main);
}

Unpacker unpacks_in_children(const std::shared_ptr<ReaderChildren>& children) {
    return [children](const std::string& archive, const std::string& main, const Limits& limits) {
        const Message question{
            MessageKind::unpack,
            {{"main", main}, {"files", limits.scene_files}, {"bytes", limits.upload_bytes}},
            archive};
        Message reply = children->ask(question, "archive");
        return PackedScene{std::move(reply.bytes),
                           static_cast<SceneFormat>(reply.values.at("format").get<int>())};
    };
}

void answer_unpack(const MessageChannel& channel, const Message& request) {
    Message reply;
    try {
        Limits limits;
        limits.scene_files = request.values.at("files").get<std::size_t>();
        limits.upload_bytes = request.values.at("bytes").get<std::size_t>();
        PackedScene scene = unpack_here(request.bytes, request.values.at("main").get<std::string>(), limits);
        reply.values = {{"format", static_cast<int>(scene.format)}};
        reply.bytes = std::move(scene.bytes);
    } catch (...) {
        reply = failure(std::current_exception());
    }
    channel.send(reply);
}

PackedScene read_scene_files(const Request& request, BlobStore& blobs, const Limits& limits,
                             const Unpacker& unpack) {
    SceneFiles files(limits);
    std::string main = request.parameter("main");
    const std::string type = request.media_type();
    if (type == zip_type) return unpack(request.body, main, limits);
    if (type == form_type)
        add_form(files, request);
    else if (const std::string named = add_blobs(files, request, blobs, limits); main.empty())
        main = named;
    return files.pack(main);
}

}  // namespace afterglow
