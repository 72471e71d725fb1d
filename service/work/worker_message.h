#pragma once

#include <filesystem>
#include <string>

#include "service/base/message_channel.h"
#include "service/jobs/job.h"
#include "service/store/scene_survey.h"
#include "solver/base/context.h"
#include "solver/sequence/edits.h"

namespace afterglow {

/// Values of the messages between the service and the process that computes a job. Reading: errors of what
/// no such process would send are ChannelClosed.

/// MessageKind::start. The reply is `done` after any `progress`.
struct StartMessage {
    Job job;
    WorldSource source;
    std::filesystem::path cache_folder;
    int threads = 0;  ///< 0: one a core
};
Message message_of(const StartMessage& start);
StartMessage start_of(const Message& message);

/// MessageKind::step. The reply is `done` after any `progress` and `revision`, or `failed`; after a `stop` an
/// Error{cancelled} that leaves the run usable, unless it was done before.
Message step_message(int frame);
int frame_of_step(const Message& message);

/// MessageKind::edit. The reply is as that of a step.
Message edit_message(const Edit& edit);
Edit edit_of(const Message& message);

Message message_of(const Progress& progress);
/// MessageKind::progress; `doing` views the message.
Progress progress_of(const Message& message);

Message message_of(const Revision& revision);
Revision revision_of(const Message& message);

/// MessageKind::done.
struct DoneMessage {
    FrameStatistics frame = {};  ///< of a step
    EditOutcome edit = {};       ///< of an edit
    SequenceStatistics sequence = {};
    Warnings warnings = {};
};
Message message_of(const DoneMessage& done);
DoneMessage done_of(const Message& message);

}  // namespace afterglow
