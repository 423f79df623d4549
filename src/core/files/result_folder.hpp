// A folder of results: one program writes it at a time, and whoever has it can tell whether its files are those
// written.
#pragma once

#include "core/files/file.hpp"
#include "core/messages/error.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv {

// Exit code 5: another program is writing there.
class FolderInUse : public RunError {
  public:
    using RunError::RunError;
};

// What was written there is gone, or elsewhere.
class FolderRemoved : public RunError {
  public:
    using RunError::RunError;
};

// Its list of checksums, which sha256sum(1) checks too.
inline constexpr std::string_view checksums_name = "checksums.sha256";

class ResultFolder {
  public:
    // Makes the folder, keeps it for this program as long as the object lives, also against a kill of others (the
    // kernel ends the lock), and removes what killed programs left unfinished. part: not empty, a word: programs that
    // each have another part of the results write here at a time. Throws FolderInUse, RunError.
    explicit ResultFolder(std::filesystem::path folder, const std::string& part = {});
    ~ResultFolder();
    ResultFolder(const ResultFolder&) = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;

    const std::filesystem::path& path() const { return folder_; }

    // Files by names relative to the folder, with sub-folders where they have some. write_file() of
    // core/files/file.hpp, and a line of the list to be. Several threads may write, each its own files. Throws
    // RunError, and FolderRemoved where the folder was removed since, or one in it.
    void write(const std::filesystem::path& name, std::string_view bytes);
    // The same by write_file_in_parts().
    void write_in_parts(const std::filesystem::path& name, const std::function<void(const AddBytes&)>& parts);
    // A line of the list for a file that is known to be whole.
    void note(const std::filesystem::path& name, std::string_view bytes);

    // Whether an earlier run wrote this file and it is still the same.
    bool holds(const std::filesystem::path& name) const;

    // While it lives, no other part of these results is in a turn; it waits until there is none.
    class Turn {
      public:
        explicit Turn(const ResultFolder& folder);
        ~Turn();
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

      private:
        int lock_;
    };

    // Last: the list of what was written and noted, and of what an earlier list has besides that is still there.
    void write_checksums() const;

  private:
    void close_all() const;
    void require_still_there() const;
    void require_folder_of(const std::filesystem::path& name);

    std::filesystem::path folder_;
    int held_ = -1;                              // the folder, by whatever name; -1: it cannot be held
    int lock_ = -1;                              // file descriptor
    int part_lock_ = -1;                         // of the part; -1: alone
    std::map<std::string, std::string> earlier_; // sums by name, of the list that was there
    std::mutex mutex_;                           // of what follows
    std::map<std::string, std::string> sums_;    // of this run
    std::set<std::filesystem::path> made_;       // folders in this one
};

// A file that is not the one that was written.
struct Damage {
    std::filesystem::path file; // relative to the folder
    std::string what;           // "is missing", "is not the file that was written"
};

struct Check {
    std::vector<std::string> files; // that were looked at, by name
    std::vector<Damage> damages;

    // Of the same folder; a file that both found damaged counts once.
    void add(const Check& other);
};

// Of the files that the folder's list names, and of the list.
Check check_by_checksums(const std::filesystem::path& folder);

} // namespace vkfv
