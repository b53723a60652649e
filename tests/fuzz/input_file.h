// A fuzz target's input as a file that a reader opens; gone after it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

#include <unistd.h>

namespace drape::fuzz
{
class InputFile
{
public:
    InputFile(const std::string& ending, const std::uint8_t* data, std::size_t size)
        : m_path(folder() + "/drape_fuzz_" + std::to_string(::getpid()) + ending)
    {
        std::ofstream(m_path, std::ios::binary).write(reinterpret_cast<const char*>(data), std::streamsize(size));
    }
    ~InputFile() { std::remove(m_path.c_str()); }
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    const std::string& path() const { return m_path; }

private:
    static std::string folder() { return ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp"; }

    std::string m_path;
};
}  // namespace drape::fuzz
