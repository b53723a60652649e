// The texts of kernels/, compiled into the library so that an installed Drape needs no data files.
//
// Job: provide every .cl file and every header that one may include, drape/query_records.h among them. Made at build
// time by cmake/EmbedKernels.cmake, sorted by path. Includes are not resolved here. Guarantee: static storage,
// zero-terminated, the files' bytes unchanged.
#pragma once

#include <cstddef>

namespace drape
{
struct EmbeddedFile
{
    const char* m_path;  // relative to the repository's root, e.g. "kernels/queries/refit.cl"
    const char* m_text;
};

extern const EmbeddedFile kEmbeddedFiles[];
extern const std::size_t kEmbeddedFileCount;
}  // namespace drape
