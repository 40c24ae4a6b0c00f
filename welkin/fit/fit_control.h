// SPDX-License-Identifier: Apache-2.0
// How whoever fits ends a long piece of work. Private to fit/.
#pragma once

#include <functional>

namespace welkin::fit {

struct FitControl {
  std::function<void()> check;  // called often, from the calling thread; may throw to stop
  std::function<bool()> late;   // true: finish now with what there is; from any thread, and true from then on
};

}  // namespace welkin::fit
