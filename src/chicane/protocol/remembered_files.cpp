// SPDX-License-Identifier: MIT
#include "chicane/protocol/remembered_files.hpp"

namespace chicane::protocol {

Result<Document> RememberedFiles::document(Shelf shelf, const std::string& name,
                                           const std::function<Result<Document>()>& read) {
  const auto known = documents_.find({shelf, name});
  if (known != documents_.end()) return known->second;
  Result<Document> document = read();
  if (!document) return document;
  if (documents_.size() == kMost) documents_.clear();
  documents_[{shelf, name}] = *document;
  return document;
}

}  // namespace chicane::protocol
