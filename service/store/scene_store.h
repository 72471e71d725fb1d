#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/jobs/job.h"
#include "service/store/database.h"
#include "solver/base/json.h"
#include "solver/scene/load.h"
#include "solver/scene/world.h"

namespace afterglow {

/// How uploaded bytes are to be read.
struct SceneUpload {
    SceneFormat format = SceneFormat::glb;
    std::string name;  ///< stands for the upload in messages
    LoadConfig load;   ///< as for a file on the command line
};

/// What is known of an uploaded scene.
struct StoredScene {
    std::string id;
    SceneUpload upload;
    std::uint64_t bytes = 0;
    std::uint64_t triangles = 0;  ///< after dropping those without area
    std::uint64_t actors = 0;
    std::vector<std::string> cameras;
    double frames_per_second = 0;
    int last_frame = 0;  ///< at that frame rate
    Warnings warnings;
};

/// JSON as http-api.md describes it.
Json to_json(const StoredScene& scene);

/// Uploaded scenes and paths documents, by names made from their content; the bytes lie in a folder of the
/// data folder. Thread-safety: all members.
class SceneStore {
  public:
    /// As `read_scene`; tests may use another.
    using Reader = std::function<Scene(std::string_view bytes, const SceneUpload& upload)>;

    /// Makes the folder. With a database, what it knows is there and what is added becomes durable. Errors:
    /// io.
    explicit SceneStore(std::filesystem::path folder, Reader reader = {}, Database* database = nullptr);

    struct Added {
        enum class Outcome { created, known };
        StoredScene scene;
        Outcome outcome = Outcome::created;
    };
    /// Reads the scene to the end before keeping it. Errors: those of read_scene and assemble; too_large past
    /// `max_triangles`; nothing is kept then.
    Added add(std::string_view bytes, const SceneUpload& upload,
              std::uint64_t max_triangles = std::numeric_limits<std::uint64_t>::max());

    /// Keeps a paths document and returns its id. Errors: invalid_input for text that is no JSON object.
    std::string add_paths(std::string_view json_text);

    [[nodiscard]] std::optional<StoredScene> find(const std::string& id) const;
    [[nodiscard]] bool has_paths(const std::string& id) const;

    /// The scene with the paths applied (none where `paths` is empty) and the background replaced, ready to
    /// be solved. Errors: not_found for ids; those of apply_paths and assemble.
    [[nodiscard]] World world(const std::string& scene, const std::string& paths,
                              const std::optional<Rgb>& background) const;

  private:
    [[nodiscard]] std::filesystem::path file_of(const std::string& id) const;
    void load();
    void keep(const std::string& id, std::string_view bytes, const std::string& sql, const Cell& about);

    std::filesystem::path folder_;
    Reader reader_;
    Database* database_;
    mutable std::mutex mutex_;
    std::map<std::string, StoredScene> scenes_;
    std::map<std::string, std::uint64_t> paths_;  ///< id → bytes
};

}  // namespace afterglow
