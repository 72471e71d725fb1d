#include "tests/unit/service/fake_solver.h"

#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <thread>

namespace afterglow {

ScratchFolder::ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "service-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch folder");
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

Scene fake_scene(std::string_view bytes, const SceneUpload& upload) {
    if (bytes.substr(0, 3) == "bad")
        throw Error(ErrorKind::invalid_input, upload.name + "#/nodes/0", "is bad");
    Scene scene;
    scene.name = upload.name;
    scene.materials.resize(1);
    scene.materials[0].name = "lamp";
    scene.materials[0].emission = Rgb(1);
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{{0, 1, 2}, 0}};
    scene.meshes = {mesh};
    scene.cameras = {{"eye", 0.7F}};
    Node triangle;
    triangle.name = "triangle";
    triangle.mesh = 0;
    Node camera;
    camera.name = "eye";
    camera.camera = 0;
    scene.nodes = {triangle, camera};
    scene.frames_per_second = 10;
    scene.duration_s = 0.9;
    return scene;
}

Revision fake_revision(int frame, int revision, int last_revision) {
    Revision out{frame, revision, revision == last_revision, 1.0 / revision, Picture(4, 2), {}};
    if (out.final) out.picture_error = 0.03;
    out.srgb.assign(4 * 2 * 3, static_cast<std::uint8_t>(revision * 20));
    return out;
}

class FakeRun : public JobRun {
  public:
    FakeRun(FakeSolver& solver, const Job& job) : solver_(solver), job_(job) { ++solver_.alive_; }
    ~FakeRun() override { --solver_.alive_; }
    FakeRun(const FakeRun&) = delete;
    FakeRun& operator=(const FakeRun&) = delete;

    FrameStatistics step(int frame, const RevisionSink& on_revision, const Context& context) override {
        begin(frame);
        const auto seed = job_.settings.sequence.seed;
        if (seed == FakeSolver::throwing_seed) throw std::logic_error("secret of the inside");
        if (seed == FakeSolver::failing_seed && frame == job_.frames.first + 1)
            throw Error(ErrorKind::cannot_converge, "material wall", "the light would grow without bound");
        if (seed == FakeSolver::hanging_seed)
            while (true) {
                context.report(0.5, "hanging");
                std::this_thread::yield();
            }
        for (int revision = 1; revision <= FakeSolver::revisions; ++revision) {
            context.report(revision / 5.0, "pretending");
            on_revision(fake_revision(frame, revision));
        }
        FrameStatistics statistics;
        statistics.error_bound = 0.125;
        return statistics;
    }
    EditOutcome apply(const Edit& edit, const Context& context) override {
        context.check_stop();
        const std::lock_guard lock(solver_.mutex_);
        solver_.edits_.push_back(edit.source.begin().key());
        return {0.5, 0, true};
    }
    [[nodiscard]] SequenceStatistics statistics() const override {
        SequenceStatistics statistics;
        statistics.patches = 99;
        return statistics;
    }
    [[nodiscard]] Warnings warnings() const override { return {{"run", "is only pretended"}}; }

  private:
    void begin(int frame) {
        std::unique_lock lock(solver_.mutex_);
        solver_.changed_.wait(
            lock, [&] { return solver_.is_open_ && solver_.steps_.size() < solver_.most_steps_; });
        solver_.steps_.emplace_back(job_.id, frame);
    }

    FakeSolver& solver_;
    Job job_;
};

RunFactory FakeSolver::factory() {
    return [this](const Job& job, const Context&, const std::stop_token&) {
        return std::make_unique<FakeRun>(*this, job);
    };
}

void FakeSolver::close() {
    const std::lock_guard lock(mutex_);
    is_open_ = false;
}

void FakeSolver::close_after(std::size_t steps) {
    const std::lock_guard lock(mutex_);
    most_steps_ = steps;
}

void FakeSolver::open() {
    {
        const std::lock_guard lock(mutex_);
        is_open_ = true;
        most_steps_ = std::numeric_limits<std::size_t>::max();
    }
    changed_.notify_all();
}

std::vector<std::string> FakeSolver::edits() const {
    const std::lock_guard lock(mutex_);
    return edits_;
}

std::vector<std::pair<std::string, int>> FakeSolver::steps() const {
    const std::lock_guard lock(mutex_);
    return steps_;
}

}  // namespace afterglow
