#pragma once

#include "service/base/message_channel.h"

namespace afterglow {

/// The process that computes one job: prepares it as `start` says, then computes a frame for every `step`
/// and takes over every `edit` until the channel closes. Errors: ChannelClosed.
void run_job_child(const MessageChannel& channel, const Message& start);

}  // namespace afterglow
