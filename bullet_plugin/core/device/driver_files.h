// Finds out from the files of the OpenCL drivers whether a machine may have a GPU, without loading a driver.
//
// Loading PoCL takes a tenth of a second and 85 MB, which an app on a machine without a GPU should not pay for. An
// unknown driver counts as a GPU's.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace drape
{
constexpr const char* kNoOpenClBuild = "this build of Drape is without OpenCL";

// The drivers that the ICD loader would load.
struct DriverFiles
{
    std::vector<std::string> m_libraries;  // names or paths
    // True if the loader may look in folders that are not known here.
    bool m_mayHaveOthers = false;
};

// Reads /etc/OpenCL/vendors, or what OCL_ICD_VENDORS, OCL_ICD_FILENAMES or OPENCL_VENDOR_PATH name in its place.
DriverFiles findDriverFiles();

// Returns the reason, in words, why these drivers show no GPU; empty if one of them may. exists: returns whether a path
// exists, such as a driver's device node.
std::string whyNoGpu(const DriverFiles& drivers, const std::function<bool(const std::string&)>& exists);

// Does the same for this machine, or says that this is a build without OpenCL. Takes less than a millisecond.
std::string whyNoGpu();
}  // namespace drape
