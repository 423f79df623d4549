#include "core/files/result_folder.hpp"

#include "core/files/digest.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <optional>
#include <sstream>
#include <system_error>

namespace vkfv {

namespace {

namespace fs = std::filesystem;

const std::string lock_name = ".lock";
const std::string part_lock_prefix = ".lock_"; // followed by the name of the part
const std::string turn_name = ".lock_turn";
constexpr std::size_t sum_digits = 64;
constexpr std::string_view between = "  "; // separator of sha256sum's lines

std::string reason() {
    return std::generic_category().message(errno);
}

struct Entry {
    std::string sum;
    std::string name;
};

// Parses a line of the list; none if it is malformed or names a file outside the folder.
std::optional<Entry> entry_of(const std::string& line) {
    if (line.size() <= sum_digits + between.size() || line.substr(sum_digits, between.size()) != between) {
        return std::nullopt;
    }
    Entry entry{.sum = line.substr(0, sum_digits), .name = line.substr(sum_digits + between.size())};
    const fs::path name(entry.name);
    const bool inside = name.is_relative() && name.lexically_normal() == name && *name.begin() != "..";
    const bool hexadecimal = entry.sum.find_first_not_of("0123456789abcdef") == std::string::npos;
    return inside && hexadecimal ? std::optional(entry) : std::nullopt;
}

// The entries of the list; malformed lines are returned in `strange`.
std::vector<Entry> entries_of(const fs::path& folder, std::vector<std::string>& strange) {
    std::vector<Entry> entries;
    std::istringstream lines(read_file(folder / checksums_name));
    for (std::string line; std::getline(lines, line);) {
        if (const auto entry = entry_of(line)) {
            entries.push_back(*entry);
        } else {
            strange.push_back(line);
        }
    }
    return entries;
}

int open_lock(const fs::path& folder, const std::string& name) {
    const fs::path path = folder / name;
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
    if (file < 0) {
        throw RunError(fmt::format("{}: cannot be written to: {}. Check its permissions, or give another --out",
                                   folder.string(), reason()));
    }
    return file;
}

// Takes a lock without waiting. how: LOCK_EX or LOCK_SH.
int lock_folder(const fs::path& folder, const std::string& name, int how) {
    const int file = open_lock(folder, name);
    if (::flock(file, how | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK) {
            ::close(file);
            throw FolderInUse(
                fmt::format("{}: another vkfv is writing {}to this folder. Wait for it to end, or give another "
                            "--out",
                            folder.string(), name == lock_name ? "" : "the same part "));
        }
        spdlog::warn("{}: this file system offers no locks ({}): see to it that no second run writes here",
                     folder.string(), reason());
    }
    return file;
}

// Removes the lock files of parts once no program writes any.
void remove_part_locks(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> locks;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (entry->path().filename().string().starts_with(part_lock_prefix)) {
            locks.push_back(entry->path());
        }
    }
    for (const fs::path& lock : locks) {
        fs::remove(lock, error);
    }
}

} // namespace

ResultFolder::ResultFolder(fs::path folder, const std::string& part) : folder_(std::move(folder)) {
    make_folder(folder_);
    lock_ = lock_folder(folder_, lock_name, part.empty() ? LOCK_EX : LOCK_SH);
    held_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    try {
        if (part.empty()) {
            remove_part_locks(folder_);
        } else {
            part_lock_ = lock_folder(folder_, part_lock_prefix + part, LOCK_EX);
        }
        remove_unfinished_files(folder_);
        std::error_code none;
        if (fs::exists(folder_ / checksums_name, none)) {
            std::vector<std::string> strange; // ignored here; vkfv verify reports them
            for (const auto& [sum, name] : entries_of(folder_, strange)) {
                earlier_[name] = sum;
            }
        }
    } catch (...) {
        close_all();
        throw;
    }
}

ResultFolder::~ResultFolder() {
    close_all();
}

void ResultFolder::close_all() const {
    for (const int file : {part_lock_, held_, lock_}) {
        if (file >= 0) {
            ::close(file);
        }
    }
}

ResultFolder::Turn::Turn(const ResultFolder& folder) : lock_(open_lock(folder.path(), turn_name)) {
    while (::flock(lock_, LOCK_EX) != 0 && errno == EINTR) {
    }
}

ResultFolder::Turn::~Turn() {
    ::close(lock_);
}

// Throws if the folder was removed: one made anew would lack the files written before.
void ResultFolder::require_still_there() const {
    struct stat held {};
    struct stat found {};
    if (held_ < 0 || ::fstat(held_, &held) != 0) {
        return;
    }
    const bool is_found = ::stat(folder_.c_str(), &found) == 0;
    if (is_found ? held.st_ino != found.st_ino || held.st_dev != found.st_dev
                 : errno == ENOENT || errno == ENOTDIR || errno == ESTALE) {
        throw FolderRemoved(
            fmt::format("{}: was removed or renamed while vkfv wrote there. Give the same command again "
                        "to begin anew, or give the folder its name back before",
                        folder_.string()));
    }
}

void ResultFolder::require_folder_of(const fs::path& name) {
    require_still_there();
    const fs::path folder = (folder_ / name).parent_path();
    const std::scoped_lock lock(mutex_);
    std::error_code none;
    if (!made_.insert(folder).second && !fs::exists(folder, none) && !none) {
        throw FolderRemoved(
            fmt::format("{}: was removed while vkfv wrote there. Give the same command again", folder.string()));
    }
    make_folder(folder);
}

void ResultFolder::write(const fs::path& name, std::string_view bytes) {
    require_folder_of(name);
    write_file(folder_ / name, bytes);
    note(name, bytes);
}

void ResultFolder::write_in_parts(const fs::path& name, const std::function<void(const AddBytes&)>& parts) {
    require_folder_of(name);
    std::string sum = write_file_in_parts(folder_ / name, parts);
    const std::scoped_lock lock(mutex_);
    sums_[name.generic_string()] = std::move(sum);
}

void ResultFolder::note(const fs::path& name, std::string_view bytes) {
    std::string sum = Digest().add(bytes).sha256();
    const std::scoped_lock lock(mutex_);
    sums_[name.generic_string()] = std::move(sum);
}

bool ResultFolder::holds(const fs::path& name) const {
    const auto listed = earlier_.find(name.generic_string());
    std::error_code none;
    return listed != earlier_.end() && fs::exists(folder_ / name, none) &&
           checksum_of_file(folder_ / name) == listed->second;
}

void ResultFolder::write_checksums() const {
    require_still_there();
    auto sums = sums_;
    std::error_code none;
    for (const auto& [name, sum] : earlier_) {
        if (fs::exists(folder_ / name, none)) {
            sums.try_emplace(name, sum);
        }
    }
    std::string text;
    for (const auto& [name, sum] : sums) {
        text += fmt::format("{}{}{}\n", sum, between, name);
    }
    write_file(folder_ / checksums_name, text);
}

void Check::add(const Check& other) {
    for (const std::string& file : other.files) {
        if (std::ranges::find(files, file) == files.end()) {
            files.push_back(file);
        }
    }
    for (const Damage& damage : other.damages) {
        if (std::ranges::find(damages, damage.file, &Damage::file) == damages.end()) {
            damages.push_back(damage);
        }
    }
}

Check check_by_checksums(const fs::path& folder) {
    Check check;
    std::error_code none;
    if (!fs::exists(folder / checksums_name, none)) {
        return check;
    }
    std::vector<std::string> strange;
    for (const auto& [sum, name] : entries_of(folder, strange)) {
        check.files.push_back(name);
        try {
            if (checksum_of_file(folder / name) != sum) {
                check.damages.push_back({name, "is not the file that was written"});
            }
        } catch (const InputError& error) {
            check.damages.push_back({name, error.problem().found});
        }
    }
    for (const std::string& line : strange) {
        check.damages.push_back(
            {fs::path(checksums_name), fmt::format("has a line that is none of a list: {:.40}", line)});
    }
    return check;
}

} // namespace vkfv
