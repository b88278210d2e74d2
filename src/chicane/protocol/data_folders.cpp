// SPDX-License-Identifier: MIT
// Search for the folders of the shipped files, from the paths of program and library; build ids of both.
#include "chicane/protocol/data_folders.hpp"

#include <elf.h>
#include <link.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#ifdef __linux__
#include <dlfcn.h>
#include <sys/auxv.h>
#endif

// Symbol of programs that were compiled with an installation, see data_folders.hpp; null in all others.
extern "C" {
[[gnu::weak]] extern const char chicane_installed_header[];
}

namespace chicane::protocol {
namespace {

namespace fs = std::filesystem;

/// Absolute path of a file, with links resolved; empty if there is no such file.
std::string existing_file(const char* path) {
  std::error_code missing;
  const fs::path file = path == nullptr ? fs::path() : fs::canonical(path, missing);
  return missing ? "" : file.string();
}

/// File of the running program; empty if unknown.
std::string running_program() {
#ifdef __linux__
  if (const std::string file = existing_file("/proc/self/exe"); !file.empty()) return file;
  return existing_file(std::bit_cast<const char*>(::getauxval(AT_EXECFN)));  // the kernel's, as a number
#else
  return "";
#endif
}

/// Shared object that contains this function; empty if unknown. dladdr() names a statically linked program as
/// it was called: only a name with a slash is a path.
std::string containing_object() {
#ifdef __linux__
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&data_folders), &info) != 0 && info.dli_fname != nullptr &&
      std::string_view(info.dli_fname).find('/') != std::string_view::npos)
    return existing_file(info.dli_fname);
#endif
  return "";
}

}  // namespace

DataOrigins data_origins() {
  DataOrigins origins;
  if (const char* folder = std::getenv("CHICANE_DATA_DIR"); folder != nullptr) origins.environment = folder;
  origins.program = running_program();
  origins.shared_object = containing_object();
  if (chicane_installed_header != nullptr) origins.header = chicane_installed_header;
  return origins;
}

std::vector<std::string> data_folders(const DataOrigins& origins, std::string_view kind) {
  std::vector<std::string> found;
  std::vector<fs::path> known;  // the same folders, with links resolved
  const auto add = [&](const fs::path& place, bool is_as_spelled = false) {
    std::error_code missing;
    fs::path folder = fs::canonical(place / kind, missing);
    if (missing) folder = fs::absolute(place / kind, missing).lexically_normal();
    if (std::find(known.begin(), known.end(), folder) != known.end()) return;
    known.push_back(folder);
    found.push_back((is_as_spelled ? place / kind : folder).string());
  };
  add(".", true);
  if (!origins.environment.empty()) add(origins.environment, true);
  for (const std::string& file : {origins.program, origins.shared_object}) {
    if (file.empty()) continue;
    const fs::path folder = fs::path(file).parent_path();
    add(folder / "share/chicane");
    add(folder / CHICANE_DATA_FROM_PROGRAM);
    add(folder / ".." / CHICANE_DATA_FROM_PROGRAM);
  }
  if (!origins.header.empty()) add(fs::path(origins.header).parent_path() / CHICANE_DATA_FROM_HEADER);
  add(CHICANE_INSTALL_DATA_DIR);
  add("/usr/share/chicane");
  return found;
}

namespace {

constexpr std::size_t padded(std::size_t size) { return (size + 3) & ~std::size_t{3}; }

/// Appends the build id among the ELF notes in [at, end).
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

/// Appends the build id of one loaded file; ends after the program, which comes first, if that has none.
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
