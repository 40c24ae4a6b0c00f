// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

#include "scratch.h"

namespace welkin::io {
namespace {

class AtomicFileTest : public Scratch {};

TEST_F(AtomicFileTest, AppearsOnlyAtCommit) {
  const auto path = folder / "a.txt";
  AtomicFile file(path);
  file.write("hello");
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(file.temporaryPath().parent_path(), folder);
  EXPECT_TRUE(file.temporaryPath().filename().string().starts_with(".a.txt."));
  file.commit();
  EXPECT_EQ(contents(path), "hello");
  EXPECT_EQ(fileCount(), 1);
}

TEST_F(AtomicFileTest, WithoutCommitTheOldFileStays) {
  const auto path = folder / "a.txt";
  writeTextFile(path, "old");
  try {
    AtomicFile file(path);
    file.write(std::string(1 << 20, 'x'));
    throw Interrupted();
  } catch (const Interrupted&) {
  }
  EXPECT_EQ(contents(path), "old");
  EXPECT_EQ(fileCount(), 1);
  writeTextFile(path, "new");
  EXPECT_EQ(contents(path), "new");
}

TEST_F(AtomicFileTest, SeeksAndWritesOver) {
  const auto path = folder / "a.bin";
  AtomicFile file(path);
  file.write("0123456789");
  file.seek(4);
  file.write("xy");
  EXPECT_EQ(file.position(), 6u);
  file.seek(12);
  file.write("!");
  file.commit();
  EXPECT_EQ(contents(path), std::string("0123xy6789\0\0!", 13));
}

TEST_F(AtomicFileTest, WritesMoreThanItsBuffer) {
  std::string text;
  for (int i = 0; i < 200000; ++i) text += std::to_string(i) + ' ';
  AtomicFile file(folder / "big");
  for (std::size_t at = 0; at < text.size(); at += 777) file.write(std::string_view(text).substr(at, 777));
  file.commit();
  EXPECT_EQ(contents(folder / "big"), text);
}

TEST_F(AtomicFileTest, ErrorsNamePathAndReason) {
  // A file is no folder, whoever asks: also root, whom permissions do not stop.
  writeTextFile(folder / "file", "");
  const std::string below = (folder / "file" / "a.png").string();
  EXPECT_EQ(messageOf<IoError>([&] { AtomicFile f(below); }), "cannot write " + below + ": Not a directory");
  const std::string missing = (folder / "none" / "a.png").string();
  EXPECT_EQ(messageOf<IoError>([&] { AtomicFile f(missing); }),
            "cannot write " + missing + ": No such file or directory");
  EXPECT_EQ(messageOf<IoError>([&] { AtomicFile f(folder); }),
            "cannot write " + folder.string() + ": Is a directory");
  EXPECT_THROW(AtomicFile("/proc/welkin.png"), IoError);
  EXPECT_THROW(AtomicFile(""), IoError);
  EXPECT_THROW(AtomicFile(folder / std::string(300, 'n')), IoError);
  EXPECT_EQ(fileCount(), 1);
}

TEST_F(AtomicFileTest, FullDiskIsAnError) {
  EXPECT_EQ(messageOf<IoError>([] { writeTextFile("/dev/full", "x"); }),
            "cannot write /dev/full: No space left on device");
  EXPECT_THROW(
      {
        AtomicFile file("/dev/full");
        file.write(std::string(1 << 20, 'x'));
      },
      IoError);
}

TEST_F(AtomicFileTest, DevicesAreWrittenNotReplaced) {
  writeTextFile("/dev/null", "x");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

// As a shell's redirections have them: what stands there stays, and so does the file.
TEST_F(AtomicFileTest, OpenFilesAreWrittenFromWhereTheyStand) {
  const auto path = folder / "log";
  for (const int mode : {0, O_APPEND}) {
    writeTextFile(path, "before\n");
    const int log = open(path.c_str(), O_WRONLY | mode);
    ASSERT_GE(log, 0);
    lseek(log, 0, SEEK_END);
    const std::string name = "/dev/fd/" + std::to_string(log);
    writeTextFile(name, "first\n");
    AtomicFile file(name);
    file.write("xecond\n");
    if (mode == 0) {
      file.seek(0);
      file.write("s");
      file.seek(7);
    } else {
      EXPECT_THROW(file.seek(0), IoError);
    }
    file.commit();
    EXPECT_EQ(write(log, "after\n", 6), 6);
    close(log);
    EXPECT_EQ(contents(path),
              mode == 0 ? "before\nfirst\nsecond\nafter\n" : "before\nfirst\nxecond\nafter\n");
  }
  EXPECT_EQ(fileCount(), 1);
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  writeTextFile("/dev/fd/" + std::to_string(ends[1]), "through");
  char read7[8] = {};
  EXPECT_EQ(read(ends[0], read7, 7), 7);
  EXPECT_STREQ(read7, "through");
  close(ends[0]);
  close(ends[1]);
}

TEST_F(AtomicFileTest, FollowsLinksAndKeepsPermissions) {
  writeTextFile(folder / "real", "old");
  chmod((folder / "real").c_str(), 0640);
  std::filesystem::create_symlink("real", folder / "link");
  writeTextFile(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(contents(folder / "real"), "new");
  EXPECT_EQ(std::filesystem::status(folder / "real").permissions(), std::filesystem::perms(0640));
}

TEST_F(AtomicFileTest, FollowsLinksToFilesThatAreNotYet) {
  std::filesystem::create_directory(folder / "there");
  std::filesystem::create_symlink("there/second", folder / "first");
  std::filesystem::create_symlink("../file", folder / "there/second");
  writeTextFile(folder / "first", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "first"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "there/second"));
  EXPECT_FALSE(std::filesystem::is_symlink(folder / "file"));
  EXPECT_EQ(contents(folder / "file"), "new");

  const std::filesystem::path elsewhere = folder / "absolute";
  std::filesystem::create_symlink(folder / "other", elsewhere);
  writeTextFile(elsewhere, "other");
  EXPECT_TRUE(std::filesystem::is_symlink(elsewhere));
  EXPECT_EQ(contents(folder / "other"), "other");
}

TEST_F(AtomicFileTest, LinksThatGoRoundAreAnError) {
  std::filesystem::create_symlink("b", folder / "a");
  std::filesystem::create_symlink("a", folder / "b");
  EXPECT_NE(messageOf<IoError>([&] { writeTextFile(folder / "a", "x"); }).find("symbolic links"),
            std::string::npos);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "a"));
  EXPECT_EQ(fileCount(), 2);
}

TEST_F(AtomicFileTest, TwoWritersOfOnePathDoNotMeet) {
  const auto path = folder / "a";
  AtomicFile first(path), second(path);
  first.write("first");
  second.write("second");
  second.commit();
  EXPECT_EQ(contents(path), "second");
  first.commit();
  EXPECT_EQ(contents(path), "first");
  EXPECT_EQ(fileCount(), 1);
}

TEST_F(AtomicFileTest, SignalHandlerLeavesNothing) {
  EXPECT_EXIT(
      {
        std::signal(SIGTERM, [](int) {
          removeUnfinishedFiles();
          _exit(9);
        });
        AtomicFile done(folder / "done");
        AtomicFile unfinished(folder / "unfinished");
        done.write("done");
        done.commit();
        unfinished.write(std::string(1 << 20, 'x'));
        std::raise(SIGTERM);
      },
      ::testing::ExitedWithCode(9), "");
  EXPECT_EQ(fileCount(), 1);
  EXPECT_EQ(contents(folder / "done"), "done");
}

}  // namespace
}  // namespace welkin::io
