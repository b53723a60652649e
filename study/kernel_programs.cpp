#include "study/kernel_programs.h"

namespace drape
{
extern const EmbeddedFile kStudyFiles[];
extern const std::size_t kStudyFileCount;

KernelTexts studyKernels()
{
    return {"study/kernels", kStudyFiles, kStudyFileCount};
}

ProgramLoader studyPrograms(Device& device, const std::string& cacheFolder, const std::string& defines)
{
    return [&device, cacheFolder, defines](const char* name)
    {
        const KernelTexts texts = studyKernels();
        const bool own = !assembleSources({std::string(texts.m_folder) + "/" + name + ".cl"}, texts).empty();
        ProgramBuild build;
        return buildProgram(device, name, cacheFolder, build, defines, own ? texts : KernelTexts());
    };
}
}  // namespace drape
