// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <csignal>

#include "welkin/core/error.h"

namespace welkin::app {
namespace {

volatile std::sig_atomic_t interrupted = 0;

extern "C" void setInterrupted(int) {
  interrupted = 1;
}

}  // namespace

void catchInterrupts() {
  struct sigaction action{};
  action.sa_handler = setInterrupted;
  action.sa_flags = SA_RESTART;  // a system call of a library is not to fail because of it
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before{};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup keeps it ignored
}

void takeFileLimitsAsErrors() {
  std::signal(SIGXFSZ, SIG_IGN);
}

void seeHowProgramsEnd() {
  std::signal(SIGCHLD, SIG_DFL);
}

void throwIfInterrupted() {
  if (interrupted) throw Interrupted();
}

}  // namespace welkin::app
