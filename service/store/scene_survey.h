#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <semaphore>
#include <string>
#include <string_view>
#include <vector>

#include "service/base/child_process.h"
#include "service/base/message_channel.h"
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

/// As `read_scene`; tests may use another.
using SceneReader = std::function<Scene(std::string_view bytes, const SceneUpload& upload)>;
SceneReader usual_reader();

/// Where a world is read from: files of the data folder.
struct WorldSource {
    std::filesystem::path scene;
    SceneUpload upload;
    std::filesystem::path paths;  ///< empty: none
};
Json to_json(const WorldSource& source);
WorldSource world_source_of(const Json& json);

/// The scene with the paths applied, ready to be solved. Errors: those of the reader, apply_paths and
/// assemble.
World read_world(const WorldSource& source, const SceneReader& reader);

/// What the service wants to know of a world.
struct SceneSurvey {
    std::uint64_t triangles = 0;  ///< after dropping those without area
    std::uint64_t actors = 0;
    std::vector<std::string> cameras;
    double frames_per_second = 0;
    int last_frame = 0;  ///< at the frame rate asked for, or else the scene's own
    Warnings warnings;
};

/// Looks at a world; `frames_per_second` 0: the scene's own. Errors: those of read_world. Thread-safety:
/// calls may come from any thread.
using Surveyor = std::function<SceneSurvey(const WorldSource& source, double frames_per_second)>;

/// Looks in this process.
Surveyor surveys_here(SceneReader reader);

/// What reading one file may cost; files come from strangers.
struct SurveyConfig {
    ChildLimits limits{std::uint64_t{4} << 30U, std::chrono::seconds(60)};  ///< of the process that reads it
    std::chrono::milliseconds wall{120'000};                                ///< from its start to its reply
    std::ptrdiff_t at_a_time = 4;                                           ///< more wait
    std::filesystem::path program = "/proc/self/exe";                       ///< what is started; for tests
};

/// A child process that reads a file of a stranger, with one question and its answer. Thread-safety: all
/// members.
class ReaderChildren {
  public:
    explicit ReaderChildren(const SurveyConfig& config) : config_(config), places_(config.at_a_time) {}
    /// `name` stands for the file. Errors: whatever the child fails with; ProblemError 422 with
    /// `scene_out_of_memory`, `scene_out_of_time` or `scene_crashed_reader`.
    Message ask(const Message& question, const std::string& name);

  private:
    SurveyConfig config_;
    std::counting_semaphore<> places_;
};

/// Looks in a child process, so that a file that takes all memory, all time or the reader's life costs
/// nothing but its request. Errors also: those of ReaderChildren.
Surveyor surveys_in_children(const std::shared_ptr<ReaderChildren>& children);
Surveyor surveys_in_children(const SurveyConfig& config = {});

/// The child's part: answers the request.
void answer_survey(const MessageChannel& channel, const Message& request);

}  // namespace afterglow
