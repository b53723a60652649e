#include "missing_device.h"

#include <filesystem>
#include <system_error>

#include "bullet_plugin/core/platform/platform.h"
#include "driver_files.h"
#include "environment.h"
#include "opencl.h"

namespace drape
{
std::string poclCacheFolder()
{
    const std::string own = variable("POCL_CACHE_DIR"), cache = variable("XDG_CACHE_HOME");
    if (!own.empty()) return own;
    return (cache.empty() ? variable("HOME") + "/.cache" : cache) + "/pocl/kcache";
}

bool canBeWritten(const std::string& folder)
{
    std::filesystem::path path = folder;
    std::error_code ignored;
    while (!std::filesystem::exists(path, ignored) && path.has_parent_path() && path != path.parent_path())
        path = path.parent_path();
    return std::filesystem::is_directory(path, ignored) && mayMakeFiles(path.string());
}

int descriptorsLeft()
{
    return openableFiles(kEnoughDescriptors);
}

std::string whyNoDeviceFound(const std::string& seen, bool poclWithoutDevice)
{
    if (!kHasOpenCl) return kNoOpenClBuild;
    const int descriptors = descriptorsLeft();
    if (descriptors < kEnoughDescriptors)
        return "this process can open " + std::to_string(descriptors) +
               " files more, and drivers are found by opening files";
    if (!hasOpenClLoader()) return std::string("this machine has no OpenCL loader, ") + kOpenClLoader + kOpenClPackage;
    if (seen.empty())
    {
        const std::string vendors = variable("OCL_ICD_VENDORS");
        return "the OpenCL loader finds no driver in " +
               (vendors.empty() ? "/etc/OpenCL/vendors" : "OCL_ICD_VENDORS, " + vendors);
    }
    if (poclWithoutDevice && !canBeWritten(poclCacheFolder()))
        return seen + "; its cache folder cannot be written: " + poclCacheFolder();
    return seen;
}
}  // namespace drape
