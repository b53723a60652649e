// Files of the cache folder: what others may have put there is neither followed nor believed, and nothing stays behind.
#include "bullet_plugin/core/device/cache_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
namespace fs = std::filesystem;

class CacheFileTest : public testing::Test
{
protected:
    bool reads(const std::string& name)
    {
        std::string bytes;
        return readCacheFile(m_folder, name, 100, bytes) && bytes == "bytes";
    }
    fs::path at(const std::string& name) const { return fs::path(m_folder) / name; }
    void put(const fs::path& path) const { std::ofstream(path) << "bytes"; }
    std::string textOf(const fs::path& path) const
    {
        std::ifstream file(path);
        return std::string(std::istreambuf_iterator<char>(file), {});
    }
    std::size_t filesInFolder() const
    {
        return std::size_t(std::distance(fs::directory_iterator(m_folder), fs::directory_iterator()));
    }

    const TemporaryFolder m_temporary;
    const std::string m_folder = m_temporary.path() + "/cache";
};
}  // namespace

TEST_F(CacheFileTest, FolderAndFileAreTheUsersAlone)
{
    writeCacheFile(m_folder, "name", "bytes");
    struct stat found;
    ASSERT_EQ(stat(m_folder.c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777u, 0700u);
    ASSERT_EQ(stat(at("name").c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777u, 0600u);
    EXPECT_TRUE(reads("name"));
    std::string bytes;
    EXPECT_FALSE(readCacheFile(m_folder, "name", 4, bytes)) << "longer than asked for";
}

TEST_F(CacheFileTest, LinksAreNotFollowed)
{
    const fs::path precious = m_temporary.path() + "/precious";
    put(precious);
    fs::create_directory(m_folder);
    fs::permissions(m_folder, fs::perms::owner_all);
    fs::create_symlink(precious, at("read"));
    EXPECT_FALSE(reads("read"));
    // Names that the temporary file may have, and the file itself.
    for (const std::string& name :
         {"name." + std::to_string(getpid()), "name." + std::to_string(getpid()) + ".0", std::string("name")})
        fs::create_symlink(precious, at(name));
    writeCacheFile(m_folder, "name", "other");
    EXPECT_EQ(textOf(precious), "bytes");
    EXPECT_EQ(textOf(at("name")), "other") << "the link was replaced";
    EXPECT_FALSE(fs::is_symlink(at("name")));
}

TEST_F(CacheFileTest, FilesThatOthersCanWriteAreNotTrusted)
{
    writeCacheFile(m_folder, "name", "bytes");
    fs::permissions(at("name"), fs::perms::others_write, fs::perm_options::add);
    EXPECT_FALSE(reads("name"));
    writeCacheFile(m_folder, "name", "bytes");
    EXPECT_TRUE(reads("name")) << "written anew";

    fs::permissions(m_folder, fs::perms::group_write | fs::perms::others_write, fs::perm_options::add);
    EXPECT_TRUE(reads("name"));
    EXPECT_EQ(fs::status(m_folder).permissions() & (fs::perms::group_write | fs::perms::others_write), fs::perms::none);

    fs::permissions(m_folder, fs::perms::all | fs::perms::sticky_bit);
    EXPECT_FALSE(reads("name")) << "a folder for everybody";
    EXPECT_EQ(fs::status(m_folder).permissions(), fs::perms::all | fs::perms::sticky_bit);
}

TEST_F(CacheFileTest, FilesOfOthersAreNotTrusted)
{
    if (geteuid() != 0) GTEST_SKIP() << "only root can give files away";
    constexpr uid_t kSomebody = 12345;
    writeCacheFile(m_folder, "name", "bytes");
    ASSERT_EQ(chown(at("name").c_str(), kSomebody, gid_t(-1)), 0);
    EXPECT_FALSE(reads("name"));
    writeCacheFile(m_folder, "name", "bytes");
    ASSERT_TRUE(reads("name"));
    ASSERT_EQ(chown(m_folder.c_str(), kSomebody, gid_t(-1)), 0);
    EXPECT_FALSE(reads("name"));
    writeCacheFile(m_folder, "another", "bytes");
    EXPECT_FALSE(fs::exists(at("another")));
}

TEST_F(CacheFileTest, NothingStaysWhereRenamingFails)
{
    fs::create_directories(at("name") / "below");
    fs::permissions(m_folder, fs::perms::owner_all);
    writeCacheFile(m_folder, "name", "bytes");
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(CacheFileTest, PipesAreNotWaitedFor)
{
    writeCacheFile(m_folder, "name", "bytes");
    ASSERT_EQ(mkfifo(at("pipe").c_str(), 0600), 0);
    EXPECT_FALSE(reads("pipe"));
}
}  // namespace drape::test
