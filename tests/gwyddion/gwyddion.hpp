// Reads files by Gwyddion's own import modules. Gwyddion is under the GPL: test programs alone are linked with it, and
// they are never shipped.
#pragma once

// libintl.h comes before Gwyddion's macros of the same names.
#include <libintl.h>

#include <libgwyddion/gwyutils.h>
#include <libgwymodule/gwymodule-file.h>
#include <libgwymodule/gwymoduleloader.h>
#include <libprocess/datafield.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

// Gwyddion's headers that declare these two functions ask for those of GTK too.
extern "C" void gwy_process_type_init(void);
extern "C" void gwy_draw_type_init(void);

// Gwyddion keeps what it allocates once until the program ends.
extern "C" const char* __asan_default_options() { // the sanitizer's own name
    return "detect_leaks=0";
}

namespace vkfv::test {

struct Unref {
    void operator()(void* object) const { g_object_unref(object); }
};
using GwyddionFile = std::unique_ptr<GwyContainer, Unref>;

inline void start_gwyddion() {
    gwy_process_type_init();
    gwy_draw_type_init();
    const std::unique_ptr<gchar, decltype(&g_free)> modules(gwy_find_self_dir("modules"), &g_free);
    const std::string folder = std::string(modules.get()) + "/file";
    const gchar* folders[] = {folder.c_str(), nullptr};
    gwy_module_register_modules(folders);
}

// The import that Gwyddion chooses by the file's content; empty if it knows none.
inline std::string gwyddion_import(const std::filesystem::path& file) {
    const gchar* name = gwy_file_detect(file.c_str(), FALSE, GWY_FILE_OPERATION_LOAD);
    return name ? name : "";
}

inline GwyddionFile load_in_gwyddion(const std::filesystem::path& file) {
    GError* error = nullptr;
    GwyddionFile loaded(gwy_file_load(file.c_str(), GWY_RUN_NONINTERACTIVE, &error));
    if (!loaded)
        throw std::runtime_error(file.string() + ": " + (error ? error->message : "not loaded"));
    return loaded;
}

// A field of the file, "/0/data" for the heights or "/0/mask" for 1 where nothing was measured; its first row is the
// one that Gwyddion shows on top.
inline GwyDataField* gwyddion_field(const GwyddionFile& file, const char* name) {
    GwyDataField* field = nullptr;
    gwy_container_gis_object_by_name(file.get(), name, &field);
    return field;
}

} // namespace vkfv::test
