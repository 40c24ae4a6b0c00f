// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "welkin/core/error.h"

namespace welkin::io {
namespace {

constexpr std::size_t kBufferBytes = 1 << 18;

// The paths of unfinished files where a signal handler can read them: fixed memory, no locks. A file that
// finds no free slot is only without that last help.
struct Slot {
  std::atomic<int> state{0};  // 0: free, 1: being filled or emptied, 2: holds a path
  std::array<char, PATH_MAX> path{};
};
std::array<Slot, 32> gUnfinished;

int registerUnfinished(const std::filesystem::path& path) {
  const std::string text = std::filesystem::absolute(path).string();
  if (text.size() >= PATH_MAX) return -1;
  for (std::size_t i = 0; i < gUnfinished.size(); ++i) {
    int expected = 0;
    if (!gUnfinished[i].state.compare_exchange_strong(expected, 1)) continue;
    std::memcpy(gUnfinished[i].path.data(), text.c_str(), text.size() + 1);
    gUnfinished[i].state = 2;
    return static_cast<int>(i);
  }
  return -1;
}

void unregisterUnfinished(int& slot) {
  if (slot >= 0) gUnfinished[static_cast<std::size_t>(slot)].state = 0;
  slot = -1;
}

// Of a path such as /proc/self/fd/1, which /dev/stdout and /dev/fd/1 link to: the number of the process's own
// open file, whatever its name is by now. -1: of none.
int openFileOf(const std::filesystem::path& path) {
  const std::string text = path.string();
  for (const std::string& folder : {std::string("/dev/fd/"), std::string("/proc/self/fd/"),
                                    "/proc/" + std::to_string(getpid()) + "/fd/"}) {
    if (!text.starts_with(folder)) continue;
    int number = -1;
    const char* end = text.data() + text.size();
    const auto [last, error] = std::from_chars(text.data() + folder.size(), end, number);
    if (error == std::errc() && last == end) return number;
  }
  return -1;
}

// The file that a path means after following symbolic links, which need not exist yet, so that a rename
// replaces the file and not the link. Where links go round it is one of them.
std::filesystem::path followLinks(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code error;
  for (int i = 0; i < kMostLinks && openFileOf(path) < 0 && std::filesystem::is_symlink(path, error); ++i) {
    const std::filesystem::path target = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / target;  // an absolute target stands alone
  }
  return path;
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path), final_(followLinks(path)) {
  if (path_.empty()) throw IoError("cannot write a file without a name");
  if (path_.filename().empty()) fail(EISDIR);
  struct stat status{};
  const bool exists = stat(final_.c_str(), &status) == 0;
  if (!exists && errno == ELOOP) fail(ELOOP);
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  if (exists && access(final_.c_str(), W_OK) != 0) fail(errno);
  const int opened = exists ? openFileOf(final_) : -1;
  direct_ = exists && (opened >= 0 || !S_ISREG(status.st_mode));
  if (opened >= 0) {
    temporary_ = final_;
    file_ = fcntl(opened, F_DUPFD_CLOEXEC, 0);
    const off_t at = lseek(file_, 0, SEEK_CUR);
    if (at > 0) origin_ = static_cast<std::uint64_t>(at);
  } else if (direct_) {
    temporary_ = final_;
    file_ = open(final_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    static std::atomic<unsigned> number{0};
    temporary_ = final_.parent_path() / ("." + final_.filename().string() + "." + std::to_string(getpid()) +
                                         "-" + std::to_string(number++) + ".tmp");
    file_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  }
  if (file_ < 0) fail(errno);
  if (!direct_) slot_ = registerUnfinished(temporary_);
  if (exists && !direct_)
    (void)!fchmod(file_, status.st_mode & 07777);  // the new file is as private as the old one
}

AtomicFile::~AtomicFile() {
  if (file_ >= 0) close(file_);
  if (!direct_ && !temporary_.empty()) unlink(temporary_.c_str());
  unregisterUnfinished(slot_);
}

void AtomicFile::fail(int error) const {
  throw IoError("cannot write " + path_.string() + ": " + std::generic_category().message(error));
}

void AtomicFile::writeThrough(const char* bytes, std::size_t left) {
  while (left > 0) {
    const ssize_t done = ::write(file_, bytes, left);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(errno);
    bytes += done;
    left -= static_cast<std::size_t>(done);
  }
}

void AtomicFile::flush() {
  writeThrough(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void AtomicFile::write(const void* bytes, std::size_t count) {
  if (buffer_.size() + count > kBufferBytes) flush();
  if (count >= kBufferBytes)
    writeThrough(static_cast<const char*>(bytes), count);
  else
    buffer_.append(static_cast<const char*>(bytes), count);
  position_ += count;
}

void AtomicFile::seek(std::uint64_t position) {
  if (position == position_) return;
  flush();
  if (direct_ && (fcntl(file_, F_GETFL) & O_APPEND) != 0) fail(ESPIPE);  // everything goes to the end
  if (lseek(file_, static_cast<off_t>(origin_ + position), SEEK_SET) < 0) fail(errno);
  position_ = position;
}

void AtomicFile::commit() {
  flush();
  const int closed = close(file_);
  file_ = -1;
  if (closed != 0) fail(errno);  // network file systems report a full disk here
  if (!direct_ && std::rename(temporary_.c_str(), final_.c_str()) != 0) fail(errno);
  temporary_.clear();
  unregisterUnfinished(slot_);
}

void writeTextFile(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

void removeUnfinishedFiles() noexcept {
  for (const Slot& slot : gUnfinished)
    if (slot.state == 2) unlink(slot.path.data());
}

}  // namespace welkin::io
