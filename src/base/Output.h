#pragma once
/// Files that appear together or not at all.

#include "base/File.h"

#include <span>
#include <string>

namespace lucent {

/// A file to write.
struct Output {
    std::string path;
    Bytes bytes;
};

/// Where a path leads: symbolic links are followed, the last one even where nothing is there yet.
std::string targetOf(const std::string& path);

/// Refuses paths that writeFiles() would refuse whatever they are to hold: what is there is no regular file
/// (a folder, a device, a pipe), or may not be written, or two of them lead to one file. "" stands for no
/// file.
Status checkOutputs(std::span<const std::string> paths);

/// Writes all files or none: when one cannot be written, all that were there before stay as they were.
///
/// What is replaced keeps its permissions, and a symbolic link stays one: what it leads to is replaced. A
/// signal that ends the program (hang-up, interrupt, terminate) does so behind the last file or before the
/// first, and leaves no temporary file. Others may see some of the files before the rest for an instant.
///
/// @return  what checkOutputs() says, or "PATH: cannot be written (reason)"
Status writeFiles(std::span<const Output> outputs);

} // namespace lucent
