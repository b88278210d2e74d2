// SPDX-License-Identifier: MIT
#include "chicane/safety/guard.hpp"
