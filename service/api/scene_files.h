#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "service/base/limits.h"
#include "service/http/http_message.h"
#include "service/store/blob_store.h"
#include "service/store/scene_survey.h"
#include "solver/scene/load.h"

namespace afterglow {

/// A scene as it goes to the scene store.
struct PackedScene {
    std::string bytes;
    SceneFormat format = SceneFormat::bundle;
};

/// The files of a scene as they are gathered from an upload, within limits. Thread-safety: none.
class SceneFiles {
  public:
    explicit SceneFiles(const Limits& limits) : limits_(limits) {}

    /// Adds a file. `place` says where it came from. Errors: invalid_input for a name that is no plain path,
    /// or is there; too_large past the limits.
    void add(const std::string& name, std::string content, const std::string& place);

    /// All of them as one; a single file goes by itself. `main` names the scene; where it is empty there must
    /// be one file that can be one. Errors: invalid_input, naming the choice.
    [[nodiscard]] PackedScene pack(const std::string& main) const;

  private:
    [[nodiscard]] std::string choose(const std::string& main) const;

    const Limits& limits_;
    std::map<std::string, std::string> files_;
    std::size_t bytes_ = 0;
};

/// The media types of uploads that hold several files.
inline constexpr const char* zip_type = "application/zip";
inline constexpr const char* form_type = "multipart/form-data";
inline constexpr const char* manifest_type = "application/vnd.afterglow.files+json";

/// The scene in a zip archive; `main` as of SceneFiles::pack. Errors: those of SceneFiles and read_zip.
using Unpacker =
    std::function<PackedScene(const std::string& archive, const std::string& main, const Limits& limits)>;

/// Unpacks in this process.
PackedScene unpack_here(const std::string& archive, const std::string& main, const Limits& limits);

/// Unpacks in a child process: archives come from strangers. Errors also: those of ReaderChildren.
Unpacker unpacks_in_children(const std::shared_ptr<ReaderChildren>& children);

/// The child's part: answers the request.
void answer_unpack(const MessageChannel& channel, const Message& request);

/// Whether an upload holds several files.
bool holds_files(const Request& request);

/// The files of such an upload: of a form, of a zip archive, or the blobs that a manifest
/// `{"main"?: NAME, "files": {NAME: {"sha256": HASH}, …}}` refers to. Query `main` names the scene. Errors:
/// those of SceneFiles and read_zip; not_found for a blob that is not there; ProblemError 400 for a manifest
/// that is no JSON.
PackedScene read_scene_files(const Request& request, BlobStore& blobs, const Limits& limits,
                             const Unpacker& unpack = unpack_here);

}  // namespace afterglow
