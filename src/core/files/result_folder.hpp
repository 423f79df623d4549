// A folder of results: one program writes it at a time, and its files can be verified later.
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

// Another program is writing to the folder; exit code 5.
class FolderInUse : public RunError {
  public:
    using RunError::RunError;
};

// The folder, or a folder in it, was removed or moved during the run.
class FolderRemoved : public RunError {
  public:
    using RunError::RunError;
};

// The file of checksums in a folder of results, which sha256sum(1) can check too.
inline constexpr std::string_view checksums_name = "checksums.sha256";

class ResultFolder {
  public:
    // Makes the folder, locks it for this program during the object's life (the kernel releases the lock if the program
    // is killed), and removes unfinished files of killed programs. part: if not empty, a word that names a part of the
    // results: programs with different parts may write at the same time. Throws FolderInUse, RunError.
    explicit ResultFolder(std::filesystem::path folder, const std::string& part = {});
    ~ResultFolder();
    ResultFolder(const ResultFolder&) = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;

    const std::filesystem::path& path() const { return folder_; }

    // Writes a file as write_file() of core/files/file.hpp, and adds it to the list. Names are relative to the folder
    // and may have sub-folders. Several threads may write different files. Throws RunError, and FolderRemoved if the
    // folder, or one in it, was removed since.
    void write(const std::filesystem::path& name, std::string_view bytes);
    // Writes a file like write(), by write_file_in_parts().
    void write_in_parts(const std::filesystem::path& name, const std::function<void(const AddBytes&)>& parts);
    // Adds a file that is known to be complete to the list.
    void note(const std::filesystem::path& name, std::string_view bytes);

    // True if an earlier run wrote this file and it has not changed.
    bool holds(const std::filesystem::path& name) const;

    // Excludes the turns of all other parts of these results during its life; the constructor waits for them to end.
    class Turn {
      public:
        explicit Turn(const ResultFolder& folder);
        ~Turn();
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

      private:
        int lock_;
    };

    // Writes the list, as the last file: all files written and noted, and those of an earlier list that still exist.
    void write_checksums() const;

  private:
    void close_all() const;
    void require_still_there() const;
    void require_folder_of(const std::filesystem::path& name);

    std::filesystem::path folder_;
    int held_ = -1;      // descriptor of the folder, which follows renames; -1: cannot be opened
    int lock_ = -1;      // file descriptor
    int part_lock_ = -1; // lock of the part; -1: no parts
    std::map<std::string, std::string> earlier_; // checksums by name, from the earlier list
    std::mutex mutex_;                           // guards the members below
    std::map<std::string, std::string> sums_;    // checksums of this run
    std::set<std::filesystem::path> made_;       // folders made within this one
};

// A file that differs from the one written.
struct Damage {
    std::filesystem::path file; // path relative to the folder
    std::string what;           // "is missing", "is not the file that was written"
};

struct Check {
    std::vector<std::string> files; // files checked, by name
    std::vector<Damage> damages;

    // Adds another check of the same folder; a file that both found damaged counts once.
    void add(const Check& other);
};

// Checks the files in the folder's list, and the list itself.
Check check_by_checksums(const std::filesystem::path& folder);

} // namespace vkfv
