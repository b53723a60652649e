#include "scenes/atomic_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/environment.h"

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

    const TemporaryFolder m_temporary;
    const fs::path m_folder = m_temporary.path();
};
}  // namespace

TEST_F(AtomicFile, ReplacesAFileAndKeepsItsPermissions)
{
    expectWritten("a", "first");
    EXPECT_EQ(contentOf(path("a")), "first");
    ASSERT_EQ(::chmod(path("a").c_str(), 0640), 0);
    expectWritten("a", "second");
    EXPECT_EQ(contentOf(path("a")), "second");
    EXPECT_EQ(fs::status(path("a")).permissions(), fs::perms(0640));
    EXPECT_EQ(entries(), 1u) << "what was temporary is left";
}

TEST_F(AtomicFile, LinksStayLinks)
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

TEST_F(AtomicFile, PipesAreWrittenTo)
{
    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    std::string read;
    std::thread reader([&] { read = contentOf(path("pipe")); });
    expectWritten("pipe", "through");
    reader.join();
    EXPECT_EQ(read, "through");
    EXPECT_TRUE(fs::is_fifo(path("pipe")));
}

TEST_F(AtomicFile, DevicesStayAndAFullOneIsAnError)
{
    ASSERT_TRUE(fs::is_character_file("/dev/full"));
    fs::create_symlink("/dev/full", path("full"));  // were it replaced, only the link would be
    std::string error;
    EXPECT_TRUE(canWriteFile(path("full"), error)) << error;
    EXPECT_FALSE(writeFileAtomically(path("full"), std::string(100000, 'x'), error));
    EXPECT_NE(error.find("full: cannot write"), std::string::npos) << error;
    EXPECT_TRUE(fs::is_character_file(path("full")));
}

TEST_F(AtomicFile, ReportsTheReasonOfAFailure)
{
    fs::create_directory(path("folder"));
    expectRefused("folder", "is a folder");
    expectRefused("nowhere/a", "no folder");
}

TEST_F(AtomicFile, LinksInACircleAreRefused)
{
    fs::create_symlink("two", path("one"));
    fs::create_symlink("one", path("two"));
    expectRefused("one", "symbolic links");
    EXPECT_TRUE(fs::is_symlink(path("one")));
}

TEST_F(AtomicFile, AFileNamedByADescriptorIsWrittenInPlace)
{
    expectWritten("a", "old");
    const int descriptor = ::open(path("a").c_str(), O_RDONLY);
    ASSERT_GE(descriptor, 0);
    fs::rename(path("a"), path("b"));
    expectWritten("a", "another");
    std::string error;
    EXPECT_TRUE(writeFileAtomically("/dev/fd/" + std::to_string(descriptor), "new", error)) << error;
    ::close(descriptor);
    EXPECT_EQ(contentOf(path("a")), "another");
    EXPECT_EQ(contentOf(path("b")), "new");
    EXPECT_EQ(entries(), 2u);
}

TEST_F(AtomicFile, OneFileUnderTwoNamesIsRecognised)
{
    fs::create_symlink("later", path("dangling"));
    EXPECT_TRUE(areOneFile(path("dangling"), path("later")));
    EXPECT_TRUE(areOneFile("no-such-file", "./no-such-file"));
    EXPECT_TRUE(areOneFile("no-such-file", (fs::current_path() / "no-such-file").string()));
    EXPECT_FALSE(areOneFile(path("a"), path("b")));
    expectWritten("a", "");
    fs::create_hard_link(path("a"), path("b"));
    EXPECT_TRUE(areOneFile(path("a"), path("b")));
    EXPECT_FALSE(areOneFile(path("a"), path("later")));
    EXPECT_FALSE(areOneFile("/dev/null", "/dev/null"));
    int one[2], two[2];
    ASSERT_EQ(::pipe(one), 0);
    ASSERT_EQ(::pipe(two), 0);
    const auto name = [](int descriptor) { return "/dev/fd/" + std::to_string(descriptor); };
    EXPECT_FALSE(areOneFile(name(one[1]), name(two[1])));
    EXPECT_TRUE(areOneFile(name(one[1]), name(one[1])));
    std::string error;
    EXPECT_TRUE(canWriteFile(name(one[1]), error)) << error;
    EXPECT_TRUE(writeFileAtomically(name(one[1]), "x", error)) << error;
    char read = 0;
    EXPECT_EQ(::read(one[0], &read, 1), 1);
    EXPECT_EQ(read, 'x');
    for (const int descriptor : {one[0], one[1], two[0], two[1]})
        ::close(descriptor);
}

// Runs in a child that gives up root's rights if the test has them.
TEST_F(AtomicFile, AReadOnlyFileStays)
{
    expectWritten("a", "old");
    fs::permissions(m_folder, fs::perms::all);
    ASSERT_EQ(::chmod(path("a").c_str(), 0400), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0)
    {
        constexpr uid_t kNobody = 65534;
        if (::geteuid() == 0 && ::setuid(kNobody) != 0) ::_exit(2);
        std::string told, error;
        const bool refused = !canWriteFile(path("a"), told) && !writeFileAtomically(path("a"), "new", error);
        ::_exit(refused && told == error && told.find("denied") != std::string::npos ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(contentOf(path("a")), "old");
}
}  // namespace drape::test
