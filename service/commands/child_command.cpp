#include "service/commands/child_command.h"

#include <new>
#include <system_error>

#include "service/api/scene_files.h"
#include "service/base/child_process.h"
#include "service/base/message_channel.h"
#include "service/store/scene_survey.h"
#include "service/work/job_child.h"

namespace afterglow {

int child_command(std::span<const char* const> arguments) {
    become_child(arguments);
    const MessageChannel channel(child_socket);
    try {
        const Message first = channel.receive();
        if (first.kind == MessageKind::survey) answer_survey(channel, first);
        if (first.kind == MessageKind::unpack) answer_unpack(channel, first);
        if (first.kind == MessageKind::start) run_job_child(channel, first);
    } catch (const ChannelClosed&) {
        return 0;  // nobody wants anything more
    } catch (const std::bad_alloc&) {
        return status_out_of_memory;
    } catch (const std::system_error& e) {
        // A thread's stack has no room.
        if (e.code() != std::errc::resource_unavailable_try_again) throw;
        return status_out_of_memory;
    }
    return 0;
}

}  // namespace afterglow
