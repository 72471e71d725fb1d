#pragma once

#include <cstddef>
#include <filesystem>

#include "service/api/usage.h"
#include "service/base/limits.h"
#include "service/http/router.h"
#include "service/store/database.h"
#include "service/store/frame_journal.h"
#include "service/store/frame_store.h"
#include "service/store/job_store.h"
#include "service/store/scene_store.h"
#include "service/work/encoder.h"
#include "service/work/job_run.h"
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
};

/// What tests may put in place of the real thing; empty members mean the real thing.
struct ServiceParts {
    SceneStore::Reader read_scene;
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
    /// Stops computing; every stream ends. What becomes of the jobs is as configured.
    void stop();

  private:
    ServiceConfig::AtStop at_stop_;
    Database database_;
    JobTable job_table_;
    JobStore jobs_;
    FrameJournal journal_;
    SceneStore scenes_;
    FrameStore frames_;
    Usage usage_;
    Encoder encoder_;
    Worker worker_;
    Router router_;
};

}  // namespace afterglow
