// The description of a failure.
//
// Drape reports a failure of the environment (no device, a kernel that does not build) and unusable input (settings,
// meshes, queries) as an Error. No exception crosses the public interface. C++11.
#pragma once

#include <string>

// The namespace of Drape's public interface.
namespace drape
{
// Says where the cause of a failure lies.
enum class ErrorKind
{
    Environment,  // a device, its driver, or the environment's variables
    Input,        // settings or arguments of the caller
    Memory        // the host ran out of memory
};

// Names the call that failed and its cause. An Error owns its text.
struct Error
{
    // The call that failed, with the OpenCL code; empty if nothing failed.
    std::string m_call;
    // The kernel, triangle or field concerned, and the whole log; may have many lines.
    std::string m_detail;
    // Side on which the cause lies; meaningful if failed() is true.
    ErrorKind m_kind = ErrorKind::Environment;

    // Returns true if this describes a failure.
    bool failed() const { return !m_call.empty(); }
    // Returns the call, then the detail on lines of its own.
    std::string text() const { return m_detail.empty() ? m_call : m_call + "\n" + m_detail; }
};
}  // namespace drape
