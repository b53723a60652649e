// A failure of the environment (no device, a kernel that does not build), or a mesh with an index out of range: the
// call that failed, the kernel or the triangle it concerned, and the whole log. A caller's other mistakes assert
// instead. No exception crosses the public interface.
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
