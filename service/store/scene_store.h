#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/base/timestamp.h"
#include "service/jobs/job.h"
#include "service/store/database.h"
#include "service/store/scene_survey.h"
#include "solver/base/json.h"

namespace afterglow {

/// What is known of an uploaded scene.
struct StoredScene {
    std::string id;
    SceneUpload upload;
    std::uint64_t bytes = 0;
    SceneSurvey survey;  ///< at its own frame rate, without paths
};

/// JSON as http-api.md describes it.
Json to_json(const StoredScene& scene);

/// Uploaded scenes and paths documents, by names made from their content; the bytes lie in a folder of the
/// data folder. Thread-safety: all members.
class SceneStore {
  public:
    /// Makes the folder. With a database, what it knows is there and what is added becomes durable. Errors:
    /// io.
    explicit SceneStore(std::filesystem::path folder, Surveyor surveyor, Database* database = nullptr,
                        SceneReader reader = usual_reader());

    struct Added {
        enum class Outcome { created, known };
        StoredScene scene;
        Outcome outcome = Outcome::created;
    };
    /// Surveys the scene before keeping it. Errors: those of the surveyor; too_large past `max_triangles`;
    /// nothing is kept then.
    Added add(std::string_view bytes, const SceneUpload& upload,
              std::uint64_t max_triangles = std::numeric_limits<std::uint64_t>::max());

    /// Keeps a paths document and returns its id. Errors: invalid_input for text that is no JSON object.
    std::string add_paths(std::string_view json_text);

    [[nodiscard]] std::optional<StoredScene> find(const std::string& id) const;
    [[nodiscard]] bool has_paths(const std::string& id) const;
    /// Whether a scene or paths are there; if so they were now asked for.
    bool ask_for(const std::string& id);

    /// A scene or paths, and when it was last uploaded or asked for.
    struct Entry {
        std::string id;
        std::chrono::system_clock::time_point asked;
    };
    [[nodiscard]] std::vector<Entry> list() const;
    /// Removes an upload unless it was asked for after `asked`. Errors: StorageError.
    void remove(const Entry& entry);

    /// Where the scene is read from with the paths applied (none where `paths` is empty) and the background
    /// replaced. Errors: not_found for ids.
    [[nodiscard]] WorldSource source(const std::string& scene, const std::string& paths,
                                     const std::optional<Rgb>& background) const;
    /// That world, read in this process: only of what has been surveyed. Errors also: those of read_world.
    [[nodiscard]] World world(const std::string& scene, const std::string& paths,
                              const std::optional<Rgb>& background) const;
    /// What that gives at a frame rate, 0 for the scene's own. Errors also: those of the surveyor.
    [[nodiscard]] SceneSurvey survey(const std::string& scene, const std::string& paths,
                                     const std::optional<Rgb>& background, double frames_per_second) const;

  private:
    [[nodiscard]] std::filesystem::path file_of(const std::string& id) const;
    [[nodiscard]] Timestamp asked(const std::string& id) const;
    void load();
    void keep(const std::string& id, std::string_view bytes, const std::string& sql, const Cell& about);

    std::filesystem::path folder_;
    Surveyor surveyor_;
    SceneReader reader_;
    Database* database_;
    mutable std::mutex mutex_;
    std::map<std::string, StoredScene> scenes_;
    std::map<std::string, std::uint64_t> paths_;  ///< id → bytes
    std::atomic<std::uint64_t> arrivals_ = 0;     ///< names files that are being looked at
};

}  // namespace afterglow
