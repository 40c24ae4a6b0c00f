// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/video.h"

#include <stdlib.h>

#include <csignal>
#include <optional>
#include <thread>

#include "scratch.h"

namespace welkin::io {
namespace {

class Video : public Scratch {
 protected:
  // A script called ffmpeg that comes first on the PATH, or a PATH with nothing on it.
  void replaceFfmpeg(const std::optional<std::string>& script) {
    if (!oldPath_) oldPath_ = getenv("PATH");
    std::filesystem::create_directory(folder / "bin");
    std::string path = (folder / "bin").string();
    if (script) {
      std::ofstream(folder / "bin/ffmpeg") << "#!/bin/sh\n" << *script << "\n";
      std::filesystem::permissions(folder / "bin/ffmpeg", std::filesystem::perms(0755));
      path += ":" + *oldPath_;  // for the script's own commands
    }
    setenv("PATH", path.c_str(), 1);
  }
  ~Video() override {
    if (oldPath_) setenv("PATH", oldPath_->c_str(), 1);
  }

 private:
  std::optional<std::string> oldPath_;
};

Image<std::uint8_t> frame(int w, int h, int number) {
  Image<std::uint8_t> image(w, h, 3);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      image.at(x, y, 0) = static_cast<std::uint8_t>(60 + x);
      image.at(x, y, 1) = static_cast<std::uint8_t>(120 + number);
      image.at(x, y, 2) = static_cast<std::uint8_t>(220 - y);
    }
  return image;
}

void writeVideo(const std::filesystem::path& path, int frames, int w = 64, int h = 48, double fps = 12.5) {
  VideoWriter video(path, {.width = w, .height = h, .fps = fps});
  for (int i = 0; i < frames; ++i) video.write(frame(w, h, i));
  video.close();
}

std::string probe(const std::filesystem::path& path, const std::string& entries) {
  return outputOf("ffprobe -v error -count_frames -select_streams v:0 -of csv=p=0 -show_entries stream=" +
                  entries + " " + path.string());
}

TEST_F(Video, BothFormatsAreReadByOthers) {
  writeVideo(folder / "a.mp4", 10);
  writeVideo(folder / "b.webm", 10);
  EXPECT_EQ(fileCount(), 2);
  EXPECT_EQ(
      probe(folder / "a.mp4", "codec_name,width,height,pix_fmt,color_space,r_frame_rate,nb_read_frames"),
      "h264,64,48,yuv420p,bt709,25/2,10\n");
  EXPECT_EQ(
      probe(folder / "b.webm", "codec_name,width,height,pix_fmt,color_space,r_frame_rate,nb_read_frames"),
      "vp9,64,48,yuv420p,bt709,25/2,10\n");
  const std::string mp4 = contents(folder / "a.mp4");
  EXPECT_LT(mp4.find("moov"), mp4.find("mdat"));  // plays before it is loaded whole
}

// Colours come back as they were sent, which fails if the matrix is not the one that the file is tagged with.
TEST_F(Video, ColoursSurvive) {
  for (const char* name : {"a.mp4", "b.webm"}) {
    Image<std::uint8_t> image(64, 64, 3);
    for (std::size_t i = 0; i < image.data.size(); i += 3) {
      image.data[i] = 40;
      image.data[i + 1] = 110;
      image.data[i + 2] = 220;
    }
    VideoWriter video(folder / name, {.width = 64, .height = 64, .fps = 30});
    for (int i = 0; i < 3; ++i) video.write(image);
    video.close();
    outputOf("ffmpeg -v error -y -i " + (folder / name).string() +
             " -frames:v 1 -vf scale=in_color_matrix=bt709 -pix_fmt rgb24 -f rawvideo " +
             (folder / "raw").string());
    const std::string raw = contents(folder / "raw");
    ASSERT_EQ(raw.size(), 64u * 64 * 3);
    const auto at = [&](std::size_t i) { return static_cast<int>(static_cast<std::uint8_t>(raw[i])); };
    const std::size_t middle = (32 * 64 + 32) * 3;
    EXPECT_NEAR(at(middle), 40, 3) << name;
    EXPECT_NEAR(at(middle + 1), 110, 3) << name;
    EXPECT_NEAR(at(middle + 2), 220, 3) << name;
  }
}

TEST_F(Video, SameFramesSameBytes) {
  for (const char* extension : {".mp4", ".webm"}) {
    writeVideo(folder / (std::string("a") + extension), 20, 320, 180);
    writeVideo(folder / (std::string("b") + extension), 20, 320, 180);
    EXPECT_EQ(contents(folder / (std::string("a") + extension)),
              contents(folder / (std::string("b") + extension)));
  }
}

TEST_F(Video, InterruptedLeavesNothing) {
  try {
    VideoWriter video(folder / "a.mp4", {.width = 640, .height = 360, .fps = 30});
    for (int i = 0; i < 5; ++i) video.write(frame(640, 360, i));
    throw Interrupted();
  } catch (const Interrupted&) {
  }
  EXPECT_EQ(fileCount(), 0);
}

TEST_F(Video, ParametersAreChecked) {
  EXPECT_NE(messageOf<ParameterError>([&] {
              VideoWriter v(folder / "a.mp4", {.width = 641, .height = 359, .fps = 30});
            }).find("a.mp4: a video of 641x359 pixels; expected even width and height, 642x360"),
            std::string::npos);
  EXPECT_THROW(VideoWriter(folder / "a.mp4", {.width = 0, .height = 0}), ParameterError);
  EXPECT_THROW(VideoWriter(folder / "a.mp4", {.fps = 0.0}), ParameterError);
  EXPECT_THROW(VideoWriter(folder / "a.avi", {}), ParameterError);
  EXPECT_THROW(VideoWriter("/proc/a.mp4", {}), IoError);
  EXPECT_NE(messageOf<IoError>([&] { VideoWriter(folder / "a.mp4", {}).close(); }).find("at least one frame"),
            std::string::npos);
  EXPECT_EQ(fileCount(), 0);
  EXPECT_TRUE(isVideoPath("A.MP4"));
  EXPECT_TRUE(isVideoPath("a.webm"));
  EXPECT_FALSE(isVideoPath("a.png"));
}

TEST_F(Video, MissingFfmpegIsAnErrorThatSaysWhatToInstall) {
  replaceFfmpeg(std::nullopt);
  EXPECT_EQ(messageOf<IoError>([&] { VideoWriter v(folder / "a.mp4", {}); }),
            "cannot write " + (folder / "a.mp4").string() +
                ": video needs the program ffmpeg, which is not on the PATH; install the package ffmpeg");
  EXPECT_EQ(fileCount(), 1);  // bin
}

TEST_F(Video, FailureShowsFfmpegsLastWords) {
  replaceFfmpeg("for i in 1 2 3 4 5 6 7; do echo \"line $i\" >&2; done; cat >/dev/null; exit 7");
  const std::string message = messageOf<IoError>([&] { writeVideo(folder / "a.mp4", 1); });
  EXPECT_NE(message.find("ffmpeg ended with code 7: line 4; line 5; line 6; line 7"), std::string::npos)
      << message;
  EXPECT_EQ(message.find("line 3"), std::string::npos);
  EXPECT_EQ(fileCount(), 1);
}

// It goes away while frames come: an error, and no SIGPIPE.
TEST_F(Video, FfmpegThatEndsEarlyIsAnError) {
  replaceFfmpeg("echo 'No space left on device' >&2; exit 1");
  const std::string message = messageOf<IoError>([&] { writeVideo(folder / "a.webm", 100, 640, 360); });
  EXPECT_NE(message.find("No space left on device"), std::string::npos) << message;
  replaceFfmpeg("kill -9 $$");
  EXPECT_NE(
      messageOf<IoError>([&] { writeVideo(folder / "a.webm", 100, 640, 360); }).find("killed by signal 9"),
      std::string::npos);
  EXPECT_EQ(fileCount(), 1);
}

// Where SIGCHLD is ignored nobody can tell whether ffmpeg wrote all of the file.
TEST_F(Video, EndThatCannotBeSeenIsAnError) {
  replaceFfmpeg("cat >/dev/null; exit 7");
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  const std::string message = messageOf<IoError>([&] { writeVideo(folder / "a.mp4", 1); });
  std::signal(SIGCHLD, before);
  EXPECT_NE(message.find("ignores SIGCHLD"), std::string::npos) << message;
  EXPECT_EQ(fileCount(), 1);  // bin
}

}  // namespace
}  // namespace welkin::io
