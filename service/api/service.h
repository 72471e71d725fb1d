#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "service/api/usage.h"
#include "service/base/limits.h"
#include "service/http/http_server.h"
#include "service/http/router.h"
#include "service/store/blob_store.h"
#include "service/store/database.h"
#include "service/store/frame_journal.h"
#include "service/store/frame_store.h"
#include "service/store/job_store.h"
#include "service/store/retention.h"
#include "service/store/scene_store.h"
#include "service/work/child_run.h"
#include "service/work/encoder.h"
#include "service/work/worker.h"

namespace afterglow {

struct ServiceConfig {
    std::filesystem::path data_folder;  ///< uploads, pictures and cached rows; made where missing
    int threads = 0;                    ///< for the solver; 0: one a core
    std::size_t max_resident = 4;       ///< jobs whose solver state is in memory at a time
    Limits limits;                      ///< what a client may ask for
    /// What a stop does to jobs that have not ended: they end too, or go on at the next start.
    enum class AtStop { cancel, keep };
    AtStop at_stop = AtStop::cancel;
    RetentionConfig retention = {};    ///< how long and how much is kept
    SurveyConfig survey = {};          ///< what reading a scene may cost
    std::uint64_t job_memory = 0;      ///< bytes that a job's process may take beyond its start; 0: any
    std::size_t ended_in_memory = 16;  ///< jobs that have ended; the others are read when they are asked for
};

/// What tests may put in place of the real thing; empty members mean the real thing.
struct ServiceParts {
    SceneReader read_scene;  ///< in this process
    RunFactory make_run;
};

/// The whole service but for the network: stores, encoder, worker and routes, joined.
/// Thread-safety: the router may be used from any number of threads.
class Service {
  public:
    /// Errors: io where the data folder cannot be used.
    explicit Service(const ServiceConfig& config, ServiceParts parts = {});
    /// As `stop`.
    ~Service();
    Service(const Service&) = delete;
    Service& operator=(const Service&) = delete;

    [[nodiscard]] const Router& router() const { return router_; }
    /// Refuses uploads past their client's quota as soon as that is known. The service must outlive it.
    [[nodiscard]] BodyCheck body_check();
    /// How many jobs, events and jobs with pictures are in memory now.
    struct Held {
        JobStore::Held jobs;
        std::size_t jobs_with_frames = 0;
    };
    [[nodiscard]] Held held() const { return {jobs_.held(), frames_.jobs_in_memory()}; }
    /// Stops computing; every stream ends. What becomes of the jobs is as configured.
    void stop();

  private:
    ServiceConfig::AtStop at_stop_;
    std::shared_ptr<ReaderChildren> readers_;
    Database database_;
    JobTable job_table_;
    JobStore jobs_;
    FrameJournal journal_;
    SceneStore scenes_;
    BlobStore blobs_;
    FrameStore frames_;
    Usage usage_;
    Encoder encoder_;
    Worker worker_;
    Retention retention_;
    Router router_;
};

}  // namespace afterglow
