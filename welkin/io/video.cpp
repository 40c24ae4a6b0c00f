// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <deque>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/io/atomic_file.h"
#include "welkin/io/file_extension.h"

namespace welkin::io {
namespace {

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  ~FileDescriptor() { reset(); }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int get() const { return fd_; }
  void reset(int fd = -1) {
    if (fd_ >= 0) close(fd_);
    fd_ = fd;
  }

 private:
  int fd_;
};

std::string shortest(double x) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
  return {text.data(), end};
}

std::vector<std::string> ffmpegArguments(const VideoSettings& settings, VideoFormat format,
                                         const std::string& out) {
  // To BT.709; without the flags swscale takes short cuts that shift colours.
  static constexpr const char* kToVideo =
      "scale=out_color_matrix=bt709:out_range=tv:"
      "flags=bicubic+accurate_rnd+full_chroma_int+full_chroma_inp+bitexact";
  std::vector<std::string> a = {
      "ffmpeg", "-hide_banner", "-nostats", "-loglevel", "error", "-y",
      // what comes: raw pictures on standard input
      "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
      std::to_string(settings.width) + "x" + std::to_string(settings.height), "-r", shortest(settings.fps),
      "-i", "pipe:0", "-an", "-vf", kToVideo, "-pix_fmt", "yuv420p", "-colorspace", "bt709",
      "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv",
      // no versions, dates or dependence on the machine in the file
      "-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-threads", "4"};
  const auto add = [&](std::initializer_list<const char*> more) {
    a.insert(a.end(), more.begin(), more.end());
  };
  if (format == VideoFormat::kMp4)
    add({"-c:v", "libx264", "-preset", "medium", "-crf", "16", "-movflags", "+faststart", "-f", "mp4"});
  else
    add({"-c:v", "libvpx-vp9", "-b:v", "0", "-crf", "20", "-deadline", "good", "-cpu-used", "4",
         "-tile-columns", "2", "-row-mt", "0", "-f", "webm"});
  a.push_back("file:" + out);  // so that a colon in the name is no protocol
  return a;
}

// The last few lines of a stream that has been written to its end, as one.
std::string lastLines(std::FILE* file) {
  constexpr std::size_t kLines = 4;
  if (std::fseek(file, 0, SEEK_SET) != 0) return {};
  std::deque<std::string> lines(1);
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
    if (c != '\n' && c != '\r') {
      lines.back() += static_cast<char>(c);
    } else if (!lines.back().empty()) {
      lines.emplace_back();
      if (lines.size() > kLines + 1) lines.pop_front();
    }
  }
  std::string text;
  for (const std::string& line : lines)
    if (!line.empty()) text += (text.empty() ? "" : "; ") + line;
  return text;
}

}  // namespace

bool isVideoPath(const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  return extension == ".mp4" || extension == ".webm";
}

VideoFormat videoFormatOf(const std::filesystem::path& path) {
  if (!isVideoPath(path))
    throw ParameterError(path.string() + ": no extension of a video; expected .mp4 or .webm");
  return lowerExtension(path) == ".mp4" ? VideoFormat::kMp4 : VideoFormat::kWebm;
}

struct VideoWriter::Impl {
  Impl(const std::filesystem::path& path, const VideoSettings& s) : file(path), settings(s) {}
  ~Impl() {
    if (process > 0) {
      kill(process, SIGKILL);
      wait();
    }
  }

  // Ends when ffmpeg has. Returns how it ended, where the system says so.
  std::optional<int> wait() {
    int status = 0;
    pid_t ended = 0;
    do {
      ended = waitpid(process, &status, 0);
    } while (ended < 0 && errno == EINTR);
    process = -1;
    return ended < 0 ? std::nullopt : std::optional(status);
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw IoError("cannot write " + file.path().string() + ": " + why);
  }

  // After ffmpeg has ended: its own explanation.
  [[noreturn]] void failWithLastWords(std::optional<int> status) const {
    const std::string how = !status ? "ended, and how is unknown, as in a process that ignores SIGCHLD"
                            : WIFSIGNALED(*status)
                                ? "was killed by signal " + std::to_string(WTERMSIG(*status))
                                : "ended with code " + std::to_string(WEXITSTATUS(*status));
    const std::string words = lastLines(messages.get());
    fail("ffmpeg " + how + (words.empty() ? "" : ": " + words));
  }

  void start(VideoFormat format);

  AtomicFile file;
  VideoSettings settings;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> messages{nullptr, std::fclose};  // ffmpeg's standard error
  FileDescriptor frames;  // our end of its standard input
  pid_t process = -1;
  bool any = false;
};

void VideoWriter::Impl::start(VideoFormat format) {
  messages.reset(std::tmpfile());
  if (!messages) fail("no temporary file: " + std::generic_category().message(errno));
  // A socket pair instead of a pipe: send() can be told not to raise SIGPIPE, so the program's signals stay
  // as they are.
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    fail("no connection to ffmpeg: " + std::generic_category().message(errno));
  frames.reset(ends[0]);
  const FileDescriptor childEnd(ends[1]);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, childEnd.get(), STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(messages.get()), STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A process group of its own: Ctrl-C reaches only us, and we decide what becomes of the file.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);

  std::vector<std::string> arguments = ffmpegArguments(settings, format, file.temporaryPath().string());
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const int error = posix_spawnp(&process, "ffmpeg", &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error == 0) return;
  process = -1;
  if (error == ENOENT)
    fail("video needs the program ffmpeg, which is not on the PATH; install the package ffmpeg");
  fail("ffmpeg does not start: " + std::generic_category().message(error));
}

VideoWriter::VideoWriter(const std::filesystem::path& path, const VideoSettings& settings) {
  const VideoFormat format = videoFormatOf(path);
  const int w = settings.width, h = settings.height;
  const std::string size = std::to_string(w) + "x" + std::to_string(h);
  if (w < 2 || h < 2 || w % 2 != 0 || h % 2 != 0)
    throw ParameterError(path.string() + ": a video of " + size +
                         " pixels; expected even width and height, " +
                         std::to_string(std::max(w + w % 2, 2)) + "x" +
                         std::to_string(std::max(h + h % 2, 2)) + " for instance");
  if (!(settings.fps > 0.0 && settings.fps <= 1000.0))
    throw ParameterError(path.string() + ": a video of " + shortest(settings.fps) +
                         " frames a second; expected more than 0 and at most 1000");
  impl_ = std::make_unique<Impl>(path, settings);
  impl_->start(format);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::write(const Image<std::uint8_t>& frame) {
  assert(frame.width == impl_->settings.width && frame.height == impl_->settings.height &&
         frame.channels == 3);
  if (impl_->process <= 0) impl_->fail("ffmpeg has ended already");
  const std::uint8_t* bytes = frame.data.data();
  std::size_t left = frame.data.size();
  while (left > 0) {
    const ssize_t done = send(impl_->frames.get(), bytes, left, MSG_NOSIGNAL);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0)
      impl_->failWithLastWords(impl_->wait());  // it has closed its end: it is ending or has ended
    bytes += done;
    left -= static_cast<std::size_t>(done);
  }
  impl_->any = true;
}

void VideoWriter::close() {
  if (!impl_->any) impl_->fail("a video needs at least one frame");
  if (impl_->process <= 0) impl_->fail("ffmpeg has ended already");
  impl_->frames.reset();  // the end of its input
  const std::optional<int> status = impl_->wait();
  if (!status || !WIFEXITED(*status) || WEXITSTATUS(*status) != 0) impl_->failWithLastWords(status);
  impl_->file.commit();
}

}  // namespace welkin::io
