#include <fstream>
#include <iterator>

#include "bullet_plugin/core/device/embedded_kernels.h"
#include "recorder/check_recording.h"
#include "recorder/coding.h"
#include "recorder/replay_data.h"
#include "scenes/atomic_file.h"

namespace drape
{
// The files of recorder/viewer, made part of the library by cmake/EmbedKernels.cmake.
extern const EmbeddedFile kViewerFiles[];
extern const std::size_t kViewerFileCount;

namespace
{
std::string viewerFile(const std::string& name)
{
    for (std::size_t i = 0; i < kViewerFileCount; ++i)
        if (kViewerFiles[i].m_path == "recorder/viewer/" + name) return kViewerFiles[i].m_text;
    return "";
}

bool readLibrary(const std::string& path, std::string& text, std::string& error)
{
    std::ifstream file(path, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(file), {});
    if (!text.empty()) return true;
    error = path + ": cannot read: a replay page needs three.js (Debian and Ubuntu: apt-get install libjs-three)";
    return false;
}

// Keeps the end tag of a script out of a script's text. In JavaScript the text means the same.
std::string asScript(std::string text)
{
    for (std::size_t at = 0; (at = text.find("</script", at)) != std::string::npos; at += 3)
        text.insert(at + 1, "\\");
    return "<script>\n" + text + "\n</script>";
}

std::string escaped(const std::string& text)
{
    std::string result;
    for (const char c : text)
        result += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
    return result;
}

void replace(std::string& page, const std::string& mark, const std::string& text)
{
    const std::size_t at = page.find(mark);
    if (at != std::string::npos) page.replace(at, mark.size(), text);
}
}  // namespace

bool writeReplay(const std::string& path, const std::vector<const Recording*>& runs, const ReplaySettings& settings,
                 std::string& error)
{
    error.clear();
    std::string three, controls;
    for (const Recording* run : runs)
        if (!checkRecording(*run, error)) return false;
    if (!readLibrary(settings.m_threeFolder + "/three.min.js", three, error) ||
        !readLibrary(settings.m_threeFolder + "/examples/js/controls/OrbitControls.js", controls, error))
        return false;
    std::string page = viewerFile("replay.html");
    replace(page, "<!--title-->", escaped(settings.m_title));
    replace(page, "<!--style-->", "<style>\n" + viewerFile("replay.css") + "</style>");
    std::string scripts = asScript(three) + asScript(controls);
    for (const char* name : {"decode.js", "scene.js", "replay.js"})
        scripts += asScript(viewerFile(name));
    replace(
        page, "<!--data-->",
        "<script id=\"data\" type=\"text/plain\">" + encodeBase64(deflated(packReplay(runs, settings))) + "</script>");
    replace(page, "<!--scripts-->", scripts);
    return writeFileAtomically(path, page, error);
}
}  // namespace drape
