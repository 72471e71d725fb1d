#include "service/store/scene_survey.h"

#include <csignal>
#include <new>
#include <utility>

#include "service/base/problem.h"
#include "solver/base/file.h"
#include "solver/sequence/sequence.h"

namespace afterglow {

namespace {

constexpr const char* paths_name = "paths";  // stands for the uploaded document in messages

SceneSurvey survey_of(const World& world, double frames_per_second) {
    SceneSurvey survey;
    for (const Body& body : world.bodies) survey.triangles += body.triangles.size();
    survey.actors = world.bodies.empty() ? 0 : world.bodies.size() - 1;
    for (const PlacedCamera& camera : world.cameras) survey.cameras.push_back(camera.camera.name);
    survey.frames_per_second = world.frames_per_second;
    SequenceConfig config;
    config.frames_per_second = frames_per_second;
    survey.last_frame = last_frame_of(world, config);
    survey.warnings = world.warnings;
    return survey;
}

Json to_json(const SceneSurvey& survey) {
    Json warnings = Json::array();
    for (const Warning& warning : survey.warnings) warnings.push_back({warning.place, warning.message});
    return {{"triangles", survey.triangles},   {"actors", survey.actors},
            {"cameras", survey.cameras},       {"frames_per_second", survey.frames_per_second},
            {"last_frame", survey.last_frame}, {"warnings", std::move(warnings)}};
}

SceneSurvey survey_of_json(const Json& json) {
    SceneSurvey survey{json.at("triangles").get<std::uint64_t>(),
                       json.at("actors").get<std::uint64_t>(),
                       json.at("cameras").get<std::vector<std::string>>(),
                       json.at("frames_per_second").get<double>(),
                       json.at("last_frame").get<int>(),
                       {}};
    for (const Json& warning : json.at("warnings"))
        survey.warnings.push_back({warning.at(0).get<std::string>(), warning.at(1).get<std::string>()});
    return survey;
}

ProblemError too_costly(const std::string& code, const std::string& detail, const std::string& name) {
    return ProblemError({422, code, detail, name});
}

/// Why there was no reply, of the way the child ended.
ProblemError problem_of_end(const ChildEnd& end, const std::string& name) {
    if (end.signal == SIGXCPU)
        return too_costly("scene_out_of_time", "reading it takes more processor time than is allowed", name);
    if (end.signal == 0 && end.status == status_out_of_memory)
        return too_costly("scene_out_of_memory", "reading it takes more memory than is allowed", name);
    return too_costly("scene_crashed_reader",
                      "it cannot be read: the process that read it ended with " + description_of(end), name);
}

/// A place among those that read at a time.
class Place {
  public:
    explicit Place(std::counting_semaphore<>& places) : places_(places) { places_.acquire(); }
    ~Place() { places_.release(); }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

  private:
    std::counting_semaphore<>& places_;
};

}  // namespace

SceneReader usual_reader() {
    return [](std::string_view bytes, const SceneUpload& upload) {
        return read_scene(bytes, upload.format, upload.name, upload.load);
    };
}

Json to_json(const WorldSource& source) {
    const LoadConfig& load = source.upload.load;
    Json json = {{"scene", source.scene.string()},
                 {"paths", source.paths.string()},
                 {"format", static_cast<int>(source.upload.format)},
                 {"name", source.upload.name},
                 {"obj_unit_m", load.obj_unit_m},
                 {"obj_up", static_cast<int>(load.obj_up)},
                 {"lumen_scale", static_cast<int>(load.lumen_scale)},
                 {"collinear_tolerance_m", load.collinear_tolerance_m},
                 {"collinear_tolerance_rad", load.collinear_tolerance_rad},
                 {"background", nullptr}};
    if (const auto& b = load.background) json["background"] = {b->r, b->g, b->b};
    return json;
}

WorldSource world_source_of(const Json& json) {
    WorldSource source;
    source.scene = json.at("scene").get<std::string>();
    source.paths = json.at("paths").get<std::string>();
    source.upload.format = static_cast<SceneFormat>(json.at("format").get<int>());
    source.upload.name = json.at("name").get<std::string>();
    LoadConfig& load = source.upload.load;
    load.obj_unit_m = json.at("obj_unit_m").get<double>();
    load.obj_up = static_cast<UpAxis>(json.at("obj_up").get<int>());
    load.lumen_scale = static_cast<LumenScale>(json.at("lumen_scale").get<int>());
    load.collinear_tolerance_m = json.at("collinear_tolerance_m").get<double>();
    load.collinear_tolerance_rad = json.at("collinear_tolerance_rad").get<double>();
    if (const Json& b = json.at("background"); !b.is_null())
        load.background = Rgb(b.at(0).get<float>(), b.at(1).get<float>(), b.at(2).get<float>());
    return source;
}

World read_world(const WorldSource& source, const SceneReader& reader) {
    Scene scene = reader(read_file(source.scene), source.upload);
    if (!source.paths.empty()) apply_paths(scene, read_file(source.paths), paths_name, source.upload.load);
    return assemble(scene, source.upload.load.collinear_tolerance_m,
                    source.upload.load.collinear_tolerance_rad);
}

Surveyor surveys_here(SceneReader reader) {
    return [reader = std::move(reader)](const WorldSource& source, double frames_per_second) {
        return survey_of(read_world(source, reader), frames_per_second);
    };
}

Message ReaderChildren::ask(const Message& question, const std::string& name) {
    const Place place(places_);
    const auto until = MessageChannel::Clock::now() + config_.wall;
    ChildProcess child(config_.limits, config_.program);
    const MessageChannel channel(child.socket());
    try {
        channel.send(question);
        Message reply = channel.receive(until);
        if (reply.kind == MessageKind::failed) throw_failure(reply);
        return reply;
    } catch (const ChannelClosed&) {
        throw problem_of_end(child.end(), name);
    } catch (const ChannelTimeout&) {
        throw too_costly("scene_out_of_time", "reading it takes longer than is allowed", name);
    } catch (const std::bad_alloc&) {
        throw too_costly("scene_out_of_memory", "reading it takes more memory than is allowed", name);
    }
}

Surveyor surveys_in_children(const std::shared_ptr<ReaderChildren>& children) {
    return [children](const WorldSource& source, double frames_per_second) {
        const Message question{MessageKind::survey,
                               {{"source", to_json(source)}, {"frames_per_second", frames_per_second}}};
        return survey_of_json(children->ask(question, source.upload.name).values);
    };
}

Surveyor surveys_in_children(const SurveyConfig& config) {
    return surveys_in_children(std::make_shared<ReaderChildren>(config));
}

void answer_survey(const MessageChannel& channel, const Message& request) {
    Message reply;
    try {
        const WorldSource source = world_source_of(request.values.at("source"));
        const double frames_per_second = request.values.at("frames_per_second").get<double>();
        reply.values = to_json(surveys_here(usual_reader())(source, frames_per_second));
    } catch (...) {
        reply = failure(std::current_exception());
    }
    channel.send(reply);
}

}  // namespace afterglow
