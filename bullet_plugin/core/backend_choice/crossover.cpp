#include "crossover.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <locale>
#include <sstream>

#include "bullet_plugin/core/device/cache_file.h"
#include "bullet_plugin/core/device/embedded_kernels.h"
#include "bullet_plugin/core/platform/platform.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "drape/version.h"

namespace drape
{
namespace
{
constexpr const char* kHead = "drape crossover 2\n";
constexpr std::size_t kMostBytes = 1 << 20;
constexpr int kHostRevision = 4;  // counts up with changes of the host's speed
constexpr double kNever = std::numeric_limits<double>::infinity();

// A value in one line.
std::string oneLine(std::string text)
{
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

std::string kernelsHash()
{
    std::uint64_t hash = kCacheHashStart;
    for (std::size_t i = 0; i < kEmbeddedFileCount; ++i)
    {
        const std::string text = kEmbeddedFiles[i].m_text;
        hash = cacheHash(text.data(), text.size(), hash);
    }
    return hexText(hash);
}

// The cores that its threads run on determine PoCL's time for a step.
std::string threadsOf(const DeviceInfo& device)
{
    const char* const variable = device.m_isGpu ? nullptr : std::getenv("POCL_AFFINITY");
    return variable ? " affinity " + oneLine(variable) : std::string();
}

std::string hashLine(const std::string& text)
{
    return "hash " + hexText(cacheHash(text.data(), text.size())) + "\n";
}

std::ostringstream plainStream()
{
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream.precision(9);
    return stream;
}
}  // namespace

double bestCrossover(std::vector<CrossoverRung> rungs)
{
    std::sort(rungs.begin(), rungs.end(),
              [](const CrossoverRung& a, const CrossoverRung& b) { return a.m_pairs < b.m_pairs; });
    const auto hostLoss = [](const CrossoverRung& rung) { return std::log(rung.m_hostMs / rung.m_deviceMs); };
    double loss = 0, least = 0, best = 0;  // against the device for all
    for (std::size_t i = 0; i < rungs.size(); ++i)
    {
        loss += hostLoss(rungs[i]);
        if (loss >= least) continue;
        least = loss;
        best = i + 1 < rungs.size() ? std::sqrt(rungs[i].m_pairs * rungs[i + 1].m_pairs) : kNever;
    }
    return best;
}

std::vector<CrossoverRung> leastTimes(std::vector<CrossoverRung> rungs, const std::vector<CrossoverRung>& others)
{
    for (const CrossoverRung& other : others)
    {
        // Scenes are the same at every start; the file stores their pairs rounded.
        const auto same = std::find_if(rungs.begin(), rungs.end(),
                                       [&](const CrossoverRung& rung)
                                       { return std::fabs(rung.m_pairs - other.m_pairs) <= 1e-6 * other.m_pairs; });
        if (same == rungs.end())
        {
            rungs.push_back(other);
            continue;
        }
        same->m_hostMs = std::min(same->m_hostMs, other.m_hostMs);
        same->m_deviceMs = std::min(same->m_deviceMs, other.m_deviceMs);
    }
    return rungs;
}

CrossoverCache::CrossoverCache(const Settings& settings, const DeviceInfo& device, std::size_t computeUnits)
    : m_folder(cacheFolder(settings.m_cacheFolder))
{
    std::ostringstream machine = plainStream(), state = plainStream();
    machine << "device " << oneLine(device.m_name) << "\nplatform " << oneLine(device.m_platform) << "\nunits "
            << computeUnits << threadsOf(device) << "\nhost " << oneLine(processorName()) << " threads "
            << ThreadTeam::sizeFor(settings.m_threads) << "\nsettings mode " << int(settings.m_mode) << " activation "
            << settings.m_activation << "\n";
    state << "driver " << oneLine(device.m_driver) << "\ndrape " << DRAPE_VERSION_STRING << " kernels " << kernelsHash()
          << " host " << kHostRevision << "\n";
    m_machine = machine.str();
    m_state = state.str();
}

std::string CrossoverCache::fileName() const
{
    return "crossover-" + hexText(cacheHash(m_machine.data(), m_machine.size())) + ".txt";
}

bool CrossoverCache::load(Crossover& crossover) const
{
    std::string text;
    if (!readCacheFile(m_folder, fileName(), kMostBytes, text)) return false;
    const std::string head = kHead + m_machine + m_state;
    const std::size_t last = text.rfind("hash ");
    if (last == std::string::npos || text.compare(0, head.size(), head) != 0) return false;
    if (text.substr(last) != hashLine(text.substr(0, last))) return false;
    std::istringstream lines(text.substr(head.size(), last - head.size()));
    lines.imbue(std::locale::classic());
    Crossover read;
    std::string word;
    while (lines >> word && word == "rung")
    {
        CrossoverRung rung;
        if (!(lines >> rung.m_pairs >> rung.m_hostMs >> rung.m_deviceMs)) return false;
        read.m_rungs.push_back(rung);
    }
    if (word != "busy" || !(lines >> read.m_busyStarts) || read.m_busyStarts < 0) return false;
    if (!(lines >> word) || word != "crossover" || !(lines >> word)) return false;
    if (word == "never")
        read.m_pairs = kNever;
    else if (std::istringstream number(word); number.imbue(std::locale::classic()), !(number >> read.m_pairs))
        return false;
    crossover = read;
    return true;
}

void CrossoverCache::store(const Crossover& crossover) const
{
    std::ostringstream text = plainStream();
    text << kHead << m_machine << m_state;
    for (const CrossoverRung& rung : crossover.m_rungs)
        text << "rung " << rung.m_pairs << " " << rung.m_hostMs << " " << rung.m_deviceMs << "\n";
    text << "busy " << crossover.m_busyStarts << "\ncrossover ";
    if (std::isinf(crossover.m_pairs))
        text << "never\n";
    else
        text << crossover.m_pairs << "\n";
    writeCacheFile(m_folder, fileName(), text.str() + hashLine(text.str()));
}
}  // namespace drape
