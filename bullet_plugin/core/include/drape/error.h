// A failure of the environment (no device, a kernel that does not build), or settings, meshes and queries that cannot
// be used: the call that failed, the kernel, triangle or field it concerned, and the whole log. No exception crosses
// the public interface.
#pragma once

#include <string>

namespace drape
{
struct Error
{
    std::string m_call;    // what was attempted, with the OpenCL code; empty when nothing failed
    std::string m_detail;  // kernel, file, log; may have many lines

    bool failed() const { return !m_call.empty(); }
    std::string text() const { return m_detail.empty() ? m_call : m_call + "\n" + m_detail; }
};
}  // namespace drape
