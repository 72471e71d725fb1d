#include "service/store/scene_store.h"

#include <system_error>
#include <utility>

#include "service/base/identity.h"
#include "service/http/http_message.h"
#include "service/store/durable_file.h"
#include "solver/base/file.h"

namespace afterglow {

namespace {

constexpr const char* paths_name = "paths";  // stands for the uploaded document in messages

/// Everything that decides what the bytes mean is part of the name; what they are called is not.
std::string id_of(std::string_view bytes, const SceneUpload& upload) {
    const std::string how = std::to_string(static_cast<int>(upload.format)) + "|" +
                            std::to_string(upload.load.obj_unit_m) + "|" +
                            std::to_string(static_cast<int>(upload.load.obj_up)) + "|";
    return content_id(how + sha256(bytes));
}

/// What is kept in the database of a scene; the bytes are a file.
Json to_record(const StoredScene& scene) {
    Json record = to_json(scene);
    record["format"] = static_cast<int>(scene.upload.format);
    record["obj_unit_m"] = scene.upload.load.obj_unit_m;
    record["obj_up"] = static_cast<int>(scene.upload.load.obj_up);
    return record;
}

StoredScene scene_of_record(const Json& record) {
    StoredScene scene;
    scene.id = record.at("id").get<std::string>();
    scene.upload.name = record.at("name").get<std::string>();
    scene.upload.format = static_cast<SceneFormat>(record.at("format").get<int>());
    scene.upload.load.obj_unit_m = record.at("obj_unit_m").get<double>();
    scene.upload.load.obj_up = static_cast<UpAxis>(record.at("obj_up").get<int>());
    scene.bytes = record.at("bytes").get<std::uint64_t>();
    scene.survey.triangles = record.at("triangles").get<std::uint64_t>();
    scene.survey.actors = record.at("actors").get<std::uint64_t>();
    scene.survey.cameras = record.at("cameras").get<std::vector<std::string>>();
    scene.survey.frames_per_second = record.at("frames_per_second").get<double>();
    scene.survey.last_frame = record.at("last_frame").get<int>();
    for (const Json& warning : record.at("warnings"))
        scene.survey.warnings.push_back(
            {warning.at("place").get<std::string>(), warning.at("message").get<std::string>()});
    return scene;
}

/// A file that is being looked at and does not belong yet.
struct Arrival {
    Arrival(std::filesystem::path at, std::string_view bytes) : path(std::move(at)) { put_file(path, bytes); }
    ~Arrival() {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
    Arrival(const Arrival&) = delete;
    Arrival& operator=(const Arrival&) = delete;

    std::filesystem::path path;
};

}  // namespace

Json to_json(const StoredScene& scene) {
    Json warnings = Json::array();
    for (const Warning& warning : scene.survey.warnings)
        warnings.push_back({{"place", warning.place}, {"message", warning.message}});
    return {{"id", scene.id},
            {"name", scene.upload.name},
            {"bytes", scene.bytes},
            {"triangles", scene.survey.triangles},
            {"actors", scene.survey.actors},
            {"cameras", scene.survey.cameras},
            {"frames_per_second", scene.survey.frames_per_second},
            {"last_frame", scene.survey.last_frame},
            {"warnings", std::move(warnings)}};
}

SceneStore::SceneStore(std::filesystem::path folder, Surveyor surveyor, Database* database,
                       SceneReader reader)
    : folder_(std::move(folder)),
      surveyor_(std::move(surveyor)),
      reader_(std::move(reader)),
      database_(database) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) throw Error(ErrorKind::io, folder_.string(), error.message());
    if (database_ != nullptr) load();
}

/// Takes what the database knows; files that it does not know were being written when the process ended.
void SceneStore::load() {
    for (const Row& row : database_->ask("SELECT id, body FROM scenes"))
        scenes_.emplace(as_text(row[0]), scene_of_record(parse_json(as_text(row[1]), "scene record")));
    for (const Row& row : database_->ask("SELECT id, bytes FROM paths"))
        paths_.emplace(as_text(row[0]), static_cast<std::uint64_t>(as_integer(row[1])));
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
        const std::string name = entry.path().filename().string();
        if (!scenes_.contains(name) && !paths_.contains(name)) std::filesystem::remove(entry.path(), error);
    }
}

/// The file, then its row. Callers hold the lock, since two uploads of one content have one name.
void SceneStore::keep(const std::string& id, std::string_view bytes, const std::string& sql,
                      const Cell& about) {
    put_file(file_of(id), bytes);
    if (database_ == nullptr) return;
    make_durable({file_of(id)});
    database_->change(sql, {id, about});
}

std::filesystem::path SceneStore::file_of(const std::string& id) const {
    return folder_ / id;
}

SceneStore::Added SceneStore::add(std::string_view bytes, const SceneUpload& upload,
                                  std::uint64_t max_triangles) {
    const std::string id = id_of(bytes, upload);
    if (ask_for(id))
        if (auto known = find(id)) return {*std::move(known), Added::Outcome::known};
    const Arrival arrival(file_of("arrival-" + std::to_string(++arrivals_)), bytes);
    StoredScene scene{id, upload, bytes.size(), surveyor_({arrival.path, upload, {}}, 0)};
    if (scene.survey.triangles > max_triangles)
        throw Error(ErrorKind::too_large, upload.name,
                    "it has " + std::to_string(scene.survey.triangles) +
                        " triangles, more than the limit of " + std::to_string(max_triangles));

    const std::lock_guard lock(mutex_);
    if (!scenes_.contains(id))
        keep(id, bytes, "INSERT OR IGNORE INTO scenes VALUES (?1, ?2)", dump(to_record(scene)));
    const auto outcome = scenes_.emplace(id, scene).second ? Added::Outcome::created : Added::Outcome::known;
    return {std::move(scene), outcome};
}

std::string SceneStore::add_paths(std::string_view json_text) {
    const Json document = parse_json(json_text, paths_name);
    if (!document.is_object()) JsonView(document, paths_name).fail("expected an object");
    std::string id = content_id("paths|" + sha256(json_text));
    if (ask_for(id)) return id;
    const std::lock_guard lock(mutex_);
    if (!paths_.contains(id)) {
        keep(id, json_text, "INSERT OR IGNORE INTO paths VALUES (?1, ?2)",
             static_cast<std::int64_t>(json_text.size()));
        paths_.emplace(id, json_text.size());
    }
    return id;
}

std::optional<StoredScene> SceneStore::find(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto it = scenes_.find(id);
    if (it == scenes_.end()) return std::nullopt;
    return it->second;
}

bool SceneStore::has_paths(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    return paths_.contains(id);
}

bool SceneStore::ask_for(const std::string& id) {
    const std::lock_guard lock(mutex_);
    if (!scenes_.contains(id) && !paths_.contains(id)) return false;
    std::error_code ignored;  // then it may go sooner
    std::filesystem::last_write_time(file_of(id), std::filesystem::file_time_type::clock::now(), ignored);
    return true;
}

/// The time of its file, so that it outlasts the process. Callers hold the lock.
Timestamp SceneStore::asked(const std::string& id) const {
    std::error_code error;
    const auto time = std::filesystem::last_write_time(file_of(id), error);
    // What cannot be asked is not said to be old.
    if (error) return std::chrono::system_clock::now();
    return std::chrono::time_point_cast<Timestamp::duration>(std::chrono::file_clock::to_sys(time));
}

std::vector<SceneStore::Entry> SceneStore::list() const {
    const std::lock_guard lock(mutex_);
    std::vector<Entry> entries;
    for (const auto& [id, scene] : scenes_) entries.push_back({id, asked(id)});
    for (const auto& [id, bytes] : paths_) entries.push_back({id, asked(id)});
    return entries;
}

void SceneStore::remove(const Entry& entry) {
    const std::lock_guard lock(mutex_);
    if (asked(entry.id) > entry.asked) return;
    // The row first: a file without one is removed at the next start.
    if (database_ != nullptr) {
        const char* table = scenes_.contains(entry.id) ? "scenes" : "paths";
        database_->change("DELETE FROM " + std::string(table) + " WHERE id = ?1", {entry.id});
    }
    scenes_.erase(entry.id);
    paths_.erase(entry.id);
    std::error_code ignored;
    std::filesystem::remove(file_of(entry.id), ignored);
}

WorldSource SceneStore::source(const std::string& scene, const std::string& paths,
                               const std::optional<Rgb>& background) const {
    const auto stored = find(scene);
    if (!stored) throw Error(ErrorKind::not_found, "scene", "there is no scene " + scene);
    if (!paths.empty() && !has_paths(paths))
        throw Error(ErrorKind::not_found, "paths", "there are no paths " + paths);
    WorldSource source{file_of(scene), stored->upload, paths.empty() ? "" : file_of(paths)};
    if (background) source.upload.load.background = background;
    return source;
}

World SceneStore::world(const std::string& scene, const std::string& paths,
                        const std::optional<Rgb>& background) const {
    return read_world(source(scene, paths, background), reader_);
}

SceneSurvey SceneStore::survey(const std::string& scene, const std::string& paths,
                               const std::optional<Rgb>& background, double frames_per_second) const {
    const WorldSource from = source(scene, paths, background);
    // What was found when it was uploaded.
    if (paths.empty() && !background && frames_per_second == 0)
        if (auto stored = find(scene)) return std::move(stored->survey);
    return surveyor_(from, frames_per_second);
}

}  // namespace afterglow
