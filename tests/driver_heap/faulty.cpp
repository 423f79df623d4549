// What the address sanitizer is to find, whoever serves the driver's allocations: see CMakeLists.txt.
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

int main(int argc, char** argv) {
    const std::string fault = argc > 1 ? argv[1] : "";
    auto* text = new std::string(1000, 'x');
    if (fault == "use-after-free") {
        delete text;
        std::puts(text->c_str());
    } else if (fault == "leak") {
        text = nullptr;
    } else if (fault == "overflow") {
        std::unique_ptr<std::string> owner(text);
        auto* const end = owner->data() + owner->capacity() + 1;
        *const_cast<volatile char*>(end) = 'x';
    }
    return 0;
}
