// Files are whole or not there, whatever their names mean.
#include "core/files/digest.hpp"
#include "core/files/file.hpp"
#include "core/messages/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <thread>

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class File : public testing::Test {
  protected:
    File() {
        fs::remove_all(folder);
        fs::create_directories(folder);
    }
    ~File() override { fs::remove_all(folder); }

    std::vector<std::string> names() const {
        std::vector<std::string> found;
        for (const auto& entry : fs::directory_iterator(folder)) {
            found.push_back(entry.path().filename().string());
        }
        return found;
    }

    fs::path folder = fs::temp_directory_path() /
                      (std::string("vkfv_file_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
                       std::to_string(getpid()));
    fs::path file = folder / "a.txt";
};

std::string refusal(const fs::path& path) {
    try {
        vkfv::read_file(path);
        return "read";
    } catch (const vkfv::InputError& error) {
        return error.problem().found;
    }
}

std::string failure(const fs::path& path) {
    try {
        vkfv::write_file(path, "new");
        return "written";
    } catch (const vkfv::RunError& error) {
        return error.what();
    }
}

TEST_F(File, IsReadAsItWasWritten) {
    std::string bytes(3 << 20, '\0');
    for (std::size_t k = 0; k < bytes.size(); ++k) {
        bytes[k] = static_cast<char>(k * 2654435761u >> 24);
    }
    vkfv::write_file(file, bytes);
    EXPECT_EQ(vkfv::read_file(file), bytes);
    vkfv::write_file(file, "");
    EXPECT_EQ(vkfv::read_file(file), "");
    EXPECT_THAT(names(), testing::ElementsAre("a.txt"));
}

TEST_F(File, InPartsIsTheSameFile) {
    const std::string whole = std::string(3 << 20, 'a') + "end";
    const std::string sum = vkfv::write_file_in_parts(file, [&](const vkfv::AddBytes& add) {
        add(whole.substr(0, 1000));
        add("");
        add(whole.substr(1000));
    });
    EXPECT_EQ(vkfv::read_file(file), whole);
    EXPECT_EQ(sum, vkfv::Digest().add(whole).sha256());
    EXPECT_EQ(vkfv::checksum_of_file(file), sum);
    // An exception of the function that makes the parts leaves the file of before, and nothing beside it.
    const auto broken = [](const vkfv::AddBytes& add) {
        add("half");
        throw vkfv::RunError("no more");
    };
    EXPECT_THROW(vkfv::write_file_in_parts(file, broken), vkfv::RunError);
    EXPECT_EQ(vkfv::checksum_of_file(file), sum);
    EXPECT_EQ(names(), std::vector<std::string>{"a.txt"});
    EXPECT_THROW(vkfv::checksum_of_file(folder), vkfv::InputError);
}

TEST_F(File, FoldersAreMade) {
    EXPECT_THAT(failure(folder / "b" / "d.txt"), HasSubstr("No such file or directory"));
    vkfv::make_folder(folder / "b" / "c" / "");
    vkfv::write_file(folder / "b" / "c" / "d.txt", "x");
    EXPECT_EQ(vkfv::read_file(folder / "b" / "c" / "d.txt"), "x");
}

TEST_F(File, WhatIsNoFileIsRefused) {
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    const int socket_number = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = (folder / "s").string();
    ASSERT_LT(name.size(), sizeof address.sun_path);
    std::strcpy(address.sun_path, name.c_str());
    ASSERT_EQ(bind(socket_number, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(refusal(folder / "pipe"), "a named pipe");
    EXPECT_EQ(refusal(folder / "s"), "a socket");
    EXPECT_EQ(refusal(folder), "a directory");
    EXPECT_EQ(refusal("/dev/zero"), "a device");
    EXPECT_EQ(refusal(folder / "none"), "no such file");
    EXPECT_THAT(refusal(folder / "x" / "none"), HasSubstr("nor a folder"));
    close(socket_number);
}

TEST_F(File, NothingButAFileIsReplaced) {
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_THAT(failure(folder / "pipe"), HasSubstr("it is a named pipe"));
    EXPECT_THAT(failure(folder), HasSubstr("it is a directory"));
    EXPECT_THAT(failure("/dev/full"), HasSubstr("it is a device"));
    vkfv::write_file(file, "old");
    fs::create_symlink("a.txt", folder / "link");
    vkfv::write_file(folder / "link", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(vkfv::read_file(file), "new");
    EXPECT_THAT(failure(file / "below"), HasSubstr("Not a directory"));
}

TEST_F(File, SeveralWritersTakeTurns) {
    std::vector<std::jthread> writers;
    for (int writer = 0; writer < 8; ++writer) {
        writers.emplace_back([&, writer] {
            for (int k = 0; k < 20; ++k) {
                vkfv::write_file(file, std::string(100'000, static_cast<char>('a' + writer)));
            }
        });
    }
    writers.clear();
    const std::string bytes = vkfv::read_file(file);
    EXPECT_EQ(bytes, std::string(100'000, bytes.front()));
    EXPECT_THAT(names(), testing::ElementsAre("a.txt"));
}

TEST_F(File, WhatDeadProgramsBeganIsRemovedAndOthersStay) {
    std::ofstream(folder / ".dead.txt.part") << "x";
    std::ofstream(folder / ".alive.txt.part") << "x";
    std::ofstream(folder / "user.part") << "x";
    const int alive = open((folder / ".alive.txt.part").c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_EQ(flock(alive, LOCK_EX), 0);
    vkfv::remove_unfinished_files(folder);
    EXPECT_THAT(names(), testing::UnorderedElementsAre(".alive.txt.part", "user.part"));
    close(alive);
}

TEST_F(File, LinesAreAppended) {
    vkfv::append_line(file, "1");
    vkfv::append_line(file, "2");
    EXPECT_EQ(vkfv::read_file(file), "1\n2\n");
    EXPECT_THROW(vkfv::append_line("/dev/full", "1"), vkfv::RunError);
}

// The sum is that of FIPS 180-4's example.
TEST(Digest, IsThatOfTheStandard) {
    vkfv::Digest digest;
    digest.add("a");
    EXPECT_EQ(digest.text().size(), 16u);
    EXPECT_EQ(digest.add("bc").sha256(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

} // namespace
