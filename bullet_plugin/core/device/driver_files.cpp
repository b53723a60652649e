#include "driver_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <system_error>

#include "environment.h"
#include "opencl.h"

namespace drape
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* kVendors = "/etc/OpenCL/vendors";

// A driver by a part of its library's name, and the device nodes of which it needs one. No node: it is for CPUs.
struct KnownDriver
{
    const char* m_part;
    std::initializer_list<const char*> m_nodes;
};
// /dev/dxg is the GPU of the Windows Subsystem for Linux.
constexpr std::initializer_list<const char*> kNone = {}, kNvidia = {"/dev/nvidiactl", "/dev/dxg"},
                                             kAmd = {"/dev/kfd", "/dev/dri", "/dev/dxg"},
                                             kIntel = {"/dev/dri", "/dev/dxg"}, kMesa = {"/dev/dri"};
constexpr KnownDriver kKnownDrivers[] = {{"pocl", kNone},    {"intelocl", kNone}, {"nvidia", kNvidia},
                                         {"amdocl", kAmd},   {"igdrcl", kIntel},  {"mesaopencl", kMesa},
                                         {"rusticl", kMesa}, {"oclgrind", kNone}};

void addFile(const fs::path& file, DriverFiles& drivers)
{
    std::ifstream text(file);
    std::string library;
    if (text >> library) drivers.m_libraries.push_back(library);
}

// A folder of .icd files, such a file, or a library.
void addEntry(const std::string& entry, DriverFiles& drivers)
{
    std::error_code ignored;
    if (entry.find('/') != std::string::npos && !fs::exists(entry, ignored)) return;
    if (fs::is_directory(entry, ignored))
    {
        for (const fs::directory_entry& file : fs::directory_iterator(entry, ignored))
            if (file.path().extension() == ".icd") addFile(file.path(), drivers);
    }
    else if (fs::path(entry).extension() == ".icd")
    {
        addFile(entry.find('/') == std::string::npos ? fs::path(kVendors) / entry : fs::path(entry), drivers);
    }
    else
    {
        drivers.m_libraries.push_back(entry);
    }
}

// PoCL drives GPUs, too, if its variable says so.
bool isForGpusToo(const std::string& library)
{
    const std::string devices = lowered(variable("POCL_DEVICES"));
    return library.find("pocl") != std::string::npos &&
           (devices.find("cuda") != std::string::npos || devices.find("level0") != std::string::npos ||
            devices.find("vulkan") != std::string::npos);
}

bool mayHaveGpu(const std::string& library, const std::function<bool(const std::string&)>& exists)
{
    const std::string name = lowered(library);
    if (isForGpusToo(name)) return true;
    for (const KnownDriver& known : kKnownDrivers)
        if (name.find(known.m_part) != std::string::npos)
            return std::any_of(known.m_nodes.begin(), known.m_nodes.end(), exists);
    return true;
}
}  // namespace

DriverFiles findDriverFiles()
{
    DriverFiles drivers;
    std::istringstream list(variable("OCL_ICD_FILENAMES"));
    for (std::string entry; std::getline(list, entry, ':');)
        if (!entry.empty()) addEntry(entry, drivers);
    const std::string vendors = variable("OCL_ICD_VENDORS"), path = variable("OPENCL_VENDOR_PATH");
    if (!vendors.empty() || !path.empty())
    {
        addEntry(vendors.empty() ? path : vendors, drivers);
        return drivers;
    }
    std::error_code ignored;
    drivers.m_mayHaveOthers = !fs::is_directory(kVendors, ignored);
    if (!drivers.m_mayHaveOthers) addEntry(kVendors, drivers);
    return drivers;
}

std::string whyNoGpu(const DriverFiles& drivers, const std::function<bool(const std::string&)>& exists)
{
    if (drivers.m_mayHaveOthers) return std::string();
    std::string names;
    for (const std::string& library : drivers.m_libraries)
    {
        if (mayHaveGpu(library, exists)) return std::string();
        names += (names.empty() ? "" : ", ") + library;
    }
    return names.empty() ? "no OpenCL driver is installed" : "no GPU: the OpenCL drivers show none (" + names + ")";
}

std::string whyNoGpu()
{
    if (!kHasOpenCl) return kNoOpenClBuild;
    return whyNoGpu(findDriverFiles(),
                    [](const std::string& path)
                    {
                        std::error_code ignored;
                        return fs::exists(path, ignored);
                    });
}
}  // namespace drape
