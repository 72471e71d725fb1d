#pragma once

#include <string>
#include <vector>

#include "service/jobs/frame_info.h"
#include "service/jobs/job.h"
#include "solver/base/json.h"

namespace afterglow {

/// JSON as http-api.md describes it.
Json to_json(const Warning& warning);
Json to_json(const Warnings& warnings);
Json to_json(const SequenceStatistics& statistics);
Json to_json(const JobSettings& settings);
Json to_json(const Job& job);

enum class PictureType { png, exr };
/// The address of a picture, immutable for a final one.
std::string picture_url(const std::string& job, const FrameInfo& info, PictureType type);

/// An entry of `/frames`.
Json frame_json(const Job& job, const FrameInfo& info);
/// The data of an `image` event.
Json image_json(const Job& job, const FrameInfo& info);

}  // namespace afterglow
