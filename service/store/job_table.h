#pragma once

#include <string>
#include <vector>

#include "service/jobs/job.h"
#include "service/store/database.h"

namespace afterglow {

/// The jobs of a database. What a call has returned from is durable. Errors: StorageError. Thread-safety: all
/// members.
class JobTable {
  public:
    /// Forgets pictures that were finished while their job was being removed.
    explicit JobTable(Database& database);

    /// In the order they were added.
    std::vector<Job> load();
    void add(const Job& job);
    void update(const Job& job);
    /// Its frames too.
    void remove(const std::string& id);

  private:
    Database& database_;
};

}  // namespace afterglow
