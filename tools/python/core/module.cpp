// The Python module vkfv._core: libvkfv with numpy's arrays, which own what the library returned and copy nothing.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <vkfv/vkfv.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace py = pybind11;

namespace {

// An array (rows, columns) over a vector that the array owns. Row 0 has the lowest y.
template <class Value>
py::array array_of(std::vector<Value> values, int rows, int columns) {
    auto owned = std::make_unique<std::vector<Value>>(std::move(values));
    const py::capsule owner(owned.get(), [](void* vector) { delete static_cast<std::vector<Value>*>(vector); });
    const Value* data = owned.release()->data();
    return py::array_t<Value>({rows, columns}, data, owner);
}

py::dict dictionary_of(vkfv::Image image) {
    py::dict result;
    result["flux"] = array_of(std::move(image.flux), image.rows, image.columns);
    result["standard_error"] = array_of(std::move(image.standard_error), image.rows, image.columns);
    result["x0_um"] = image.x0_um;
    result["y0_um"] = image.y0_um;
    result["pitch_um"] = image.pitch_um;
    result["z_um"] = image.z_um;
    return result;
}

py::list list_of(vkfv::Stack stack) {
    py::list result;
    for (auto& image : stack.images) {
        result.append(dictionary_of(std::move(image)));
    }
    return result;
}

vkfv::Stack stack_of(const std::vector<py::array_t<float, py::array::c_style | py::array::forcecast>>& images) {
    vkfv::Stack stack;
    for (const auto& values : images) {
        if (values.ndim() != 2) {
            throw py::value_error("an image of vkfv has two dimensions, (rows, columns)");
        }
        vkfv::Image image;
        image.rows = static_cast<int>(values.shape(0));
        image.columns = static_cast<int>(values.shape(1));
        image.flux.assign(values.data(), values.data() + values.size());
        stack.images.push_back(std::move(image));
    }
    return stack;
}

py::dict dictionary_of(vkfv::Topography found) {
    py::dict result;
    const auto put = [&](const char* name, auto values) {
        if (!values.empty()) {
            result[name] = array_of(std::move(values), found.rows, found.columns);
        }
    };
    put("heights_um", std::move(found.heights_um));
    put("height_uncertainty_um", std::move(found.height_uncertainty_um));
    put("height_noise_um", std::move(found.height_noise_um));
    put("contrast", std::move(found.contrast));
    put("truth_um", std::move(found.truth_um));
    put("measured", std::move(found.measured));
    result["x0_um"] = found.x0_um;
    result["y0_um"] = found.y0_um;
    result["pitch_um"] = found.pitch_um;
    return result;
}

// Runs without Python's lock.
template <class Work>
auto unlocked(const Work& work) {
    const py::gil_scoped_release released;
    return work();
}

} // namespace

PYBIND11_MODULE(_core, module) {
    // The package gives errors its own classes: cause is "input", "device" or "run".
    static PyObject* failure = PyErr_NewException("vkfv._core.Failure", PyExc_Exception, nullptr);
    module.attr("Failure") = py::handle(failure);
    py::register_exception_translator([](std::exception_ptr pointer) {
        try {
            std::rethrow_exception(pointer);
        } catch (const vkfv::Error& error) {
            const char* causes[] = {"input", "device", "run"};
            py::list problems;
            for (const auto& problem : error.problems()) {
                problems.append(py::dict(py::arg("place") = problem.place, py::arg("key") = problem.key,
                                         py::arg("found") = problem.found, py::arg("expectation") = problem.expectation,
                                         py::arg("remedy") = problem.remedy));
            }
            const py::tuple what = py::make_tuple(error.what(), causes[static_cast<int>(error.cause())], problems);
            PyErr_SetObject(failure, what.ptr());
        }
    });
    py::class_<vkfv::Scene>(module, "Scene")
        .def(py::init<const std::string&>())
        .def("set",
             [](vkfv::Scene& scene, const std::string& key, const std::string& value) {
                 unlocked([&] {
                     scene.set(key, value);
                     return 0;
                 });
             })
        .def("positions_um", [](const vkfv::Scene& scene) { return unlocked([&] { return scene.positions_um(); }); })
        .def("configuration", [](const vkfv::Scene& scene) { return unlocked([&] { return scene.configuration(); }); })
        .def("lights_made", [](const vkfv::Scene& scene) { return unlocked([&] { return scene.lights_made(); }); })
        .def("image",
             [](vkfv::Scene& scene, double z_um) { return dictionary_of(unlocked([&] { return scene.image(z_um); })); })
        .def(
            "stack",
            [](vkfv::Scene& scene, const std::optional<py::function>& progress) {
                // An interrupt, or an exception of `progress`, ends the stack at the next image.
                const auto told = [&](int done, int images) {
                    const py::gil_scoped_acquire locked;
                    if (PyErr_CheckSignals() != 0) {
                        throw py::error_already_set();
                    }
                    if (progress) {
                        (*progress)(done, images);
                    }
                };
                return list_of(unlocked([&] { return scene.stack(told); }));
            },
            py::arg("progress") = py::none())
        .def("evaluate", [](vkfv::Scene& scene,
                            const std::vector<py::array_t<float, py::array::c_style | py::array::forcecast>>& images) {
            const auto stack = stack_of(images);
            return dictionary_of(unlocked([&] { return scene.evaluate(stack); }));
        });
}
