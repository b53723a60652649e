#include "program.h"

#include <cctype>
#include <cstring>
#include <set>
#include <sstream>

#include "kernels/shared/mesh.h"
#include "missing_device.h"
#include "opencl_lock.h"
#include "program_cache.h"

namespace drape
{
namespace
{
// Contraction is off by pragma too: options can be ignored, and half of all dot products differ with it.
constexpr const char* kPreamble = "#pragma OPENCL FP_CONTRACT OFF\n";
#define DRAPE_TEXT_OF(x) #x
#define DRAPE_TEXT(x) DRAPE_TEXT_OF(x)
constexpr const char* kOptions =
    "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt -DDRAPE_DOP_DIRECTIONS=" DRAPE_TEXT(DRAPE_DOP_DIRECTIONS);
static_assert(DRAPE_DOP_DIRECTIONS == 3 || DRAPE_DOP_DIRECTIONS == 7 || DRAPE_DOP_DIRECTIONS == 9 ||
                  DRAPE_DOP_DIRECTIONS == 13,
              "volumes have 6, 14, 18 or 26 sides");

// Most registers of a work-item, so that a compute unit of NVIDIA holds one group more. patchWalk takes 84 by itself;
// on an H200 with 131,072 triangles it takes 63 µs with these and 56 µs with 72.
struct RegisterLimit
{
    const char* m_program;
    int m_registers;
};
constexpr RegisterLimit kRegisterLimits[] = {{"broad_phase/patch_traversal_gpu", 72}};

// Returns the options for the program with these files.
std::string optionsFor(Device& device, const std::vector<std::string>& names)
{
    std::string options = kOptions;
    if (device.handle().getInfo<CL_DEVICE_EXTENSIONS>().find("cl_nv_compiler_options") == std::string::npos)
        return options;
    for (const RegisterLimit& limit : kRegisterLimits)
        if (names.size() == 1 && names[0] == limit.m_program)
            options += " -cl-nv-maxrregcount=" + std::to_string(limit.m_registers);
    return options;
}

const char* findText(const std::string& path, const KernelTexts& others)
{
    const KernelTexts own = {"kernels", kEmbeddedFiles, kEmbeddedFileCount};
    for (const KernelTexts* texts : {&own, &others})
    {
        for (std::size_t i = 0; i < texts->m_count; ++i)
            if (path == texts->m_files[i].m_path) return texts->m_files[i].m_text;
    }
    return nullptr;
}

// "kernels/lib" and "../shared/types.h" give "kernels/shared/types.h".
std::string joinPath(std::string folder, std::string file)
{
    while (file.compare(0, 3, "../") == 0)
    {
        file.erase(0, 3);
        const std::size_t slash = folder.rfind('/');
        folder.erase(slash == std::string::npos ? 0 : slash);
    }
    return folder.empty() ? file : folder + "/" + file;
}

std::string lineDirective(std::size_t line, const std::string& path)
{
    return "#line " + std::to_string(line) + " \"" + path + "\"\n";
}

// Returns whether a file is a text that compiles once per SIMD width, so that it is included more than once.
bool isForAnyWidth(const std::string& path)
{
    return path.find("/any_width/") != std::string::npos;
}

void append(const std::string& path, const KernelTexts& others, std::set<std::string>& seen, std::string& source)
{
    const char* text = findText(path, others);
    if (!text)
    {
        source += "#error cannot find " + path + "\n";
        return;
    }
    const std::size_t slash = path.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : path.substr(0, slash);
    source += lineDirective(1, path);
    std::size_t line = 0;
    for (const char* begin = text; *begin != '\0';)
    {
        const char* end = std::strchr(begin, '\n');
        const std::string content = end ? std::string(begin, end) : std::string(begin);
        ++line;
        const std::string keyword = "#include \"";
        if (content.compare(0, keyword.size(), keyword) == 0)
        {
            const std::string file = content.substr(keyword.size(), content.rfind('"') - keyword.size());
            const std::string included = joinPath(folder, file);
            if (seen.insert(included).second || isForAnyWidth(included)) append(included, others, seen, source);
            source += lineDirective(line + 1, path);
        }
        else
        {
            source += content + "\n";
        }
        begin = end ? end + 1 : begin + content.size();
    }
}

// Returns e.g. "kernels/queries/refit.cl:26" for a line of an assembled source, counted from 1 with the directives.
std::string originOfLine(const std::string& source, std::size_t wanted)
{
    std::istringstream lines(source);
    std::string text, file;
    std::size_t line = 0;
    for (std::size_t physical = 1; physical <= wanted && std::getline(lines, text); ++physical, ++line)
    {
        const std::string keyword = "#line ";
        if (text.compare(0, keyword.size(), keyword) != 0) continue;
        const std::size_t quote = text.find('"');
        line = std::stoul(text.substr(keyword.size())) - 1;  // the next line has the number that the directive names
        file = text.substr(quote + 1, text.rfind('"') - quote - 1);
    }
    return file + ":" + std::to_string(line - 1);
}

bool build(Device& device, cl::Program& program, const std::string& what, const std::string& source,
           const std::string& options)
{
    const cl_int code = program.build(std::vector<cl::Device>{device.handle()}, options.c_str());
    if (code == CL_SUCCESS) return true;
    std::string log;
    program.getBuildInfo(device.handle(), CL_PROGRAM_BUILD_LOG, &log);
    device.check(code, "building " + what, translateLog(log, source));
    return false;
}
}  // namespace

bool keepsItsOwn(const DeviceInfo& device)
{
    return device.m_platform == kPoclPlatform;
}

std::string assembleSources(const std::vector<std::string>& paths, const KernelTexts& others)
{
    std::set<std::string> seen;
    std::string source = kPreamble;
    for (const std::string& path : paths)
    {
        if (!findText(path, others)) return std::string();
        append(path, others, seen, source);
    }
    return source;
}

std::string translateLog(const std::string& log, const std::string& source)
{
    const std::string mark = "<kernel>:";
    std::string translated;
    std::size_t from = 0;
    for (std::size_t at = log.find(mark); at != std::string::npos; at = log.find(mark, from))
    {
        const std::size_t number = at + mark.size();
        std::size_t end = number;
        while (end < log.size() && end < number + 9 && std::isdigit(static_cast<unsigned char>(log[end])))
            ++end;
        translated += log.substr(from, at - from);
        translated += end > number ? originOfLine(source, std::stoul(log.substr(number, end - number))) : mark;
        from = end;
    }
    return translated + log.substr(from);
}

cl::Program compileSource(Device& device, const std::string& what, const std::string& source, const char* options)
{
    const OpenClLock lock;
    cl_int code = CL_SUCCESS;
    cl::Program program(device.context(), source, false, &code);
    if (device.check(code, "clCreateProgramWithSource", what))
        build(device, program, what, source, options ? options : kOptions);
    return program;
}

cl::Program buildJoinedProgram(Device& device, const std::vector<std::string>& names, const std::string& cacheFolder,
                               ProgramBuild& result, const std::string& defines, const KernelTexts& texts)
{
    result.m_fromCache = false;
    if (device.failed()) return cl::Program();
    std::vector<std::string> paths;
    std::string what;
    for (const std::string& name : names)
    {
        paths.push_back(std::string(texts.m_folder) + "/" + name + ".cl");
        what += (what.empty() ? "" : ", ") + paths.back();
    }
    const std::string kind = device.isGpu() ? "" : "#define DRAPE_CPU\n";
    const std::string source = kind + defines + assembleSources(paths, texts);
    const ProgramCache cache(cacheFolder);
    const std::string options = optionsFor(device, names);
    const std::string key = cache.key(source, options, device.info());
    std::vector<unsigned char> binary;
    const bool kept = keepsItsOwn(device.info());
    if (!kept && cache.load(key, binary))
    {
        const OpenClLock lock;
        cl_int code = CL_SUCCESS;
        cl::Program program(device.context(), {device.handle()}, cl::Program::Binaries{binary}, nullptr, &code);
        if (code == CL_SUCCESS &&
            program.build(std::vector<cl::Device>{device.handle()}, options.c_str()) == CL_SUCCESS)
        {
            result.m_fromCache = true;
            return program;
        }
    }
    cl::Program program = compileSource(device, what, source, options.c_str());
    if (device.failed() || kept) return program;
    const OpenClLock lock;
    std::vector<std::vector<unsigned char>> binaries;
    if (program.getInfo(CL_PROGRAM_BINARIES, &binaries) == CL_SUCCESS && binaries.size() == 1)
    {
        cache.store(key, binaries[0]);
    }
    return program;
}

void Kernel::create(Device& device, const cl::Program& program, const char* name)
{
    m_name = name;
    m_arguments.clear();
    if (device.failed()) return;
    const OpenClLock lock;
    cl_int code = CL_SUCCESS;
    m_kernel = cl::Kernel(program, name, &code);
    device.check(code, "clCreateKernel", name);
}

bool Kernel::isSet(cl_uint index, const Identity& value)
{
    if (index >= m_arguments.size()) m_arguments.resize(index + 1);
    const std::pair<bool, Identity> argument(true, value);
    if (m_arguments[index] == argument) return true;
    m_arguments[index] = argument;
    return false;
}

void Kernel::forgetOldBuffers(const Device& device)
{
    if (m_bufferCount == device.bufferCount()) return;
    m_bufferCount = device.bufferCount();
    m_arguments.clear();
}

void Kernel::enqueue(Device& device, std::size_t globalSize, std::size_t localSize)
{
    if (device.failed()) return;
    const std::size_t rounded = (globalSize + localSize - 1) / localSize * localSize;
    cl::Event* event = device.profiler() ? device.profiler()->add(m_name) : nullptr;
    device.check(device.queue().enqueueNDRangeKernel(m_kernel, cl::NullRange, cl::NDRange(rounded),
                                                     cl::NDRange(localSize), nullptr, event),
                 "clEnqueueNDRangeKernel", m_name);
}
}  // namespace drape
