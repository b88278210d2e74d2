// SPDX-License-Identifier: MIT
// Carries the precompiled headers of tests/CMakeLists.txt; has nothing of its own.
