// SPDX-License-Identifier: MIT
#include "chicane/protocol/build_id.hpp"

#include <elf.h>
#include <link.h>

#include <cstddef>
#include <cstring>

namespace chicane::protocol {
namespace {

constexpr std::size_t padded(std::size_t size) { return (size + 3) & ~std::size_t{3}; }

/// The build id among the notes in [at, end).
void add_build_id(const char* at, const char* end, std::string& ids) {
  while (end - at >= static_cast<std::ptrdiff_t>(sizeof(ElfW(Nhdr)))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, at, sizeof note);
    const char* const name = at + sizeof note;
    const std::size_t behind = padded(note.n_namesz) + padded(note.n_descsz);
    if (static_cast<std::size_t>(end - name) < behind) return;
    const char* const text = name + padded(note.n_namesz);
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 && std::memcmp(name, "GNU", 4) == 0)
      ids.append(text, note.n_descsz);
    at = name + behind;
  }
}

/// Of one loaded file; the program comes first.
int add_build_ids(dl_phdr_info* info, std::size_t, void* data) {
  auto& ids = *static_cast<std::string*>(data);
  const bool is_program = ids.empty();
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& segment = info->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    const char* at = reinterpret_cast<const char*>(info->dlpi_addr + segment.p_vaddr);
    add_build_id(at, at + segment.p_memsz, ids);
  }
  return is_program && ids.empty() ? 1 : 0;
}

}  // namespace

std::string build_ids() {
  std::string ids;
  dl_iterate_phdr(&add_build_ids, &ids);
  return ids;
}

}  // namespace chicane::protocol
