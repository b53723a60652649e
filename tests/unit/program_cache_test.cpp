// The cache of compiled programs: a round trip, and every trouble reads as "not there".
#include "bullet_plugin/core/device/program_cache.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
namespace fs = std::filesystem;

class ProgramCacheTest : public testing::Test
{
protected:
    void SetUp() override
    {
        m_device.m_platform = "platform";
        m_device.m_name = "device";
        m_device.m_driver = "1";
        for (int i = 0; i < 1000; ++i)
            m_binary.push_back(static_cast<unsigned char>(i * 7));
    }

    fs::path storedFile()
    {
        m_cacheKey = ProgramCache(m_folder).key("source", "options", m_device);
        ProgramCache(m_folder).store(m_cacheKey, m_binary);
        return fs::path(m_folder) / m_cacheKey;
    }
    bool loads()
    {
        std::vector<unsigned char> loaded;
        return ProgramCache(m_folder).load(m_cacheKey, loaded) && loaded == m_binary;
    }

    const TemporaryFolder m_temporary;
    const std::string m_folder = m_temporary.path();
    std::string m_cacheKey;
    DeviceInfo m_device;
    std::vector<unsigned char> m_binary;
};
}  // namespace

TEST_F(ProgramCacheTest, RoundTrip)
{
    EXPECT_FALSE(loads());
    EXPECT_TRUE(fs::exists(storedFile()));
    EXPECT_TRUE(loads());
    EXPECT_EQ(std::distance(fs::directory_iterator(m_folder), fs::directory_iterator()), 1)
        << "no temporary file stays";
}

TEST_F(ProgramCacheTest, MakesMissingFolders)
{
    const std::string deep = m_folder + "/a/b/c";
    ProgramCache(deep).store("key", m_binary);
    std::vector<unsigned char> loaded;
    EXPECT_TRUE(ProgramCache(deep).load("key", loaded));
}

TEST_F(ProgramCacheTest, EveryTruncationReadsAsNotThere)
{
    const fs::path file = storedFile();
    for (std::uintmax_t size = fs::file_size(file); size-- > 0;)
    {
        fs::resize_file(file, size);
        ASSERT_FALSE(loads()) << size << " bytes";
    }
}

TEST_F(ProgramCacheTest, EveryFlippedByteReadsAsNotThere)
{
    const fs::path file = storedFile();
    std::ifstream input(file, std::ios::binary);
    const std::string good((std::istreambuf_iterator<char>(input)), std::istreambuf_iterator<char>());
    for (std::size_t at = 0; at < good.size(); ++at)
    {
        std::string bad = good;
        bad[at] = char(bad[at] ^ 0x40);
        std::ofstream(file, std::ios::binary) << bad;
        ASSERT_FALSE(loads()) << "byte " << at;
    }
}

TEST_F(ProgramCacheTest, ForeignFileAndFolderInItsPlace)
{
    const fs::path file = storedFile();
    std::ofstream(file) << "something else, long enough to hold a header and more";
    EXPECT_FALSE(loads());
    fs::remove(file);
    fs::create_directory(file);
    EXPECT_FALSE(loads());
    ProgramCache(m_folder).store(m_cacheKey, m_binary);
    EXPECT_FALSE(loads());
}

TEST_F(ProgramCacheTest, FolderThatCannotBeWritten)
{
    // A file has a folder's name: not even root can write below it.
    std::ofstream(m_folder + "/file") << "x";
    const ProgramCache cache(m_folder + "/file/below");
    cache.store("key", m_binary);
    std::vector<unsigned char> loaded;
    EXPECT_FALSE(cache.load("key", loaded));
    const ProgramCache system("/proc/drape");
    system.store("key", m_binary);
    EXPECT_FALSE(system.load("key", loaded));
}

TEST_F(ProgramCacheTest, NoneMeansNone)
{
    const fs::path before = fs::current_path();
    fs::current_path(m_folder);
    const ProgramCache cache("none");
    cache.store("key", m_binary);
    std::vector<unsigned char> loaded;
    EXPECT_FALSE(cache.load("key", loaded));
    EXPECT_TRUE(fs::is_empty(m_folder));
    fs::current_path(before);
}

TEST_F(ProgramCacheTest, EmptyFolderMeansTheUsersCache)
{
    const char* previous = std::getenv("XDG_CACHE_HOME");
    const std::string kept = previous ? previous : "";
    setenv("XDG_CACHE_HOME", m_folder.c_str(), 1);
    ProgramCache("").store("key", m_binary);
    previous ? setenv("XDG_CACHE_HOME", kept.c_str(), 1) : unsetenv("XDG_CACHE_HOME");
    EXPECT_TRUE(fs::exists(m_folder + "/drape/key"));
}

TEST_F(ProgramCacheTest, KeyDependsOnEverything)
{
    const ProgramCache cache(m_folder);
    const std::string key = cache.key("source", "options", m_device);
    EXPECT_EQ(key, cache.key("source", "options", m_device));
    EXPECT_NE(key, cache.key("source2", "options", m_device));
    EXPECT_NE(key, cache.key("source", "options2", m_device));
    EXPECT_NE(key, cache.key("sourceo", "ptions", m_device));
    for (std::string DeviceInfo::*field : {&DeviceInfo::m_platform, &DeviceInfo::m_name, &DeviceInfo::m_driver})
    {
        DeviceInfo other = m_device;
        other.*field += "x";
        EXPECT_NE(key, cache.key("source", "options", other));
    }
}
}  // namespace drape::test
