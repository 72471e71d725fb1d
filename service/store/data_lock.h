#pragma once

#include <filesystem>

namespace afterglow {

/// Holds a data folder for this process: two services in one folder would overwrite each other's state. The
/// system lets go of it when the process ends, however it does.
class DataLock {
  public:
    /// Makes the folder where it is missing. Errors: io where another process holds it, naming that process,
    /// or where nothing can be written.
    explicit DataLock(const std::filesystem::path& folder);
    ~DataLock();
    DataLock(const DataLock&) = delete;
    DataLock& operator=(const DataLock&) = delete;

  private:
    int file_ = -1;
};

}  // namespace afterglow
