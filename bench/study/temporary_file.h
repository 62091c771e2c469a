// The file that is written in the place of another until it is complete: beside it, of a name that nobody can foresee
// (O_EXCL, O_NOFOLLOW), with the owner and mode of the one whose place it takes, or those of a new one.
#pragma once

#include <filesystem>

namespace poinsot::study {

// The descriptor, or -1 with errno.
int open_temporary(const std::filesystem::path& real, std::filesystem::path& temporary);
// It has its name, or is gone.
void forget_temporary(const std::filesystem::path& file);

// Removes the files that are not complete: for handlers of signals, it neither allocates nor locks.
void remove_unfinished() noexcept;

}  // namespace poinsot::study
