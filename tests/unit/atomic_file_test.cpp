#include "scenes/atomic_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <sys/stat.h>
#include <unistd.h>

namespace drape::test
{
namespace
{
namespace fs = std::filesystem;

std::string contentOf(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

class AtomicFile : public testing::Test
{
protected:
    AtomicFile() : m_folder(fs::temp_directory_path() / ("drape-atomic-" + std::to_string(::getpid())))
    {
        fs::create_directory(m_folder);
    }
    ~AtomicFile() override { fs::remove_all(m_folder); }

    std::string path(const std::string& name) const { return (m_folder / name).string(); }

    // Expects that it is told beforehand, too.
    void expectWritten(const std::string& name, const std::string& bytes)
    {
        std::string error;
        EXPECT_TRUE(canWriteFile(path(name), error)) << error;
        EXPECT_TRUE(writeFileAtomically(path(name), bytes, error)) << error;
    }

    void expectRefused(const std::string& name, const std::string& reason)
    {
        std::string told, error;
        EXPECT_FALSE(canWriteFile(path(name), told));
        EXPECT_NE(told.find(reason), std::string::npos) << told;
        EXPECT_FALSE(writeFileAtomically(path(name), "new", error));
        EXPECT_NE(error.find(path(name) + ": cannot write: "), std::string::npos) << error;
    }

    std::size_t entries() const
    {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(m_folder), fs::directory_iterator()));
    }

    const fs::path m_folder;
};
}  // namespace

TEST_F(AtomicFile, isNewOrReplacedWithItsPermissions)
{
    expectWritten("a", "first");
    EXPECT_EQ(contentOf(path("a")), "first");
    ASSERT_EQ(::chmod(path("a").c_str(), 0640), 0);
    expectWritten("a", "second");
    EXPECT_EQ(contentOf(path("a")), "second");
    EXPECT_EQ(fs::status(path("a")).permissions(), fs::perms(0640));
    EXPECT_EQ(entries(), 1u) << "what was temporary is left";
}

TEST_F(AtomicFile, linksStayLinks)
{
    fs::create_directory(path("folder"));
    expectWritten("folder/target", "old");
    fs::create_symlink("folder/target", path("link"));
    fs::create_symlink("link", path("linkToLink"));
    fs::create_symlink("folder/later", path("dangling"));
    expectWritten("linkToLink", "new");
    expectWritten("dangling", "made");
    for (const char* link : {"link", "linkToLink", "dangling"})
        EXPECT_TRUE(fs::is_symlink(path(link))) << link;
    EXPECT_EQ(contentOf(path("folder/target")), "new");
    EXPECT_EQ(contentOf(path("folder/later")), "made");
}

TEST_F(AtomicFile, pipesAreWrittenTo)
{
    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    std::string read;
    std::thread reader([&] { read = contentOf(path("pipe")); });
    expectWritten("pipe", "through");
    reader.join();
    EXPECT_EQ(read, "through");
    EXPECT_TRUE(fs::is_fifo(path("pipe")));
}

TEST_F(AtomicFile, devicesStayAndAFullOneIsAnError)
{
    if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    fs::create_symlink("/dev/full", path("full"));  // were it replaced, only the link would be
    std::string error;
    EXPECT_TRUE(canWriteFile(path("full"), error)) << error;
    EXPECT_FALSE(writeFileAtomically(path("full"), std::string(100000, 'x'), error));
    EXPECT_NE(error.find("full: cannot write"), std::string::npos) << error;
    EXPECT_TRUE(fs::is_character_file(path("full")));
}

TEST_F(AtomicFile, saysWhyNot)
{
    fs::create_directory(path("folder"));
    expectRefused("folder", "is a folder");
    expectRefused("nowhere/a", "no folder");
}

TEST_F(AtomicFile, whatIsReadOnlyStays)
{
    expectWritten("a", "old");
    if (::geteuid() == 0) GTEST_SKIP() << "root may write what is read-only";
    ASSERT_EQ(::chmod(path("a").c_str(), 0400), 0);
    expectRefused("a", "denied");
    EXPECT_EQ(contentOf(path("a")), "old");
}
}  // namespace drape::test
