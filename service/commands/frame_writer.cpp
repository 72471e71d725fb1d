#include "service/commands/frame_writer.h"

#include "solver/image/frame_files.h"

namespace afterglow {

void FrameWriter::begin(Revision picture) {
    finish();
    writing_ = std::async(std::launch::async, [folder = folder_, picture = std::move(picture)] {
        write_frame(folder, picture.frame, picture.radiance, picture.srgb);
    });
}

void FrameWriter::finish() {
    if (writing_.valid()) writing_.get();
}

}  // namespace afterglow
