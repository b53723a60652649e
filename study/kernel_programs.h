// Programs of the study's kernels and, where a stage asks for them, of the library's.
#pragma once

#include <string>

#include "bullet_plugin/core/device/program.h"

namespace drape
{
// Gives the program of study/kernels/<name>.cl, or of kernels/<name>.cl where the study has none of that name. The
// device stays. cacheFolder, defines: see buildJoinedProgram().
ProgramLoader studyPrograms(Device& device, const std::string& cacheFolder = std::string(),
                            const std::string& defines = std::string());

// The study's texts.
KernelTexts studyKernels();
}  // namespace drape
