#pragma once
/// JSON reports: one object per run, schema "latewarp.<subcommand>/1". Only report.cpp sees the JSON library.

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/machine.h"
#include "apps/options.h"
#include "core/result.h"
#include "core/statistics.h"
#include "gl/context.h"
#include "scene/scene.h"

namespace lw {

/// A tree of named values in the order they were first set. A path names a value from the root, parts separated by
/// '/': "error/flip", "baselines/points:size_px=2/error". Setting a path again replaces its value. One thread.
class Report {
public:
    /// An empty object.
    Report();
    /// With "schema": "latewarp.<subcommand>/1".
    explicit Report(Subcommand subcommand);
    Report(Report&&) noexcept;
    Report& operator=(Report&&) noexcept;
    ~Report();

    void set(std::string_view path, double number);  ///< not finite becomes null: a number that cannot be trusted
    void set(std::string_view path, std::int64_t number);
    void set(std::string_view path, int number) { set(path, static_cast<std::int64_t>(number)); }
    void set(std::string_view path, std::uint64_t number);
    void set(std::string_view path, bool flag);
    void set(std::string_view path, std::string_view text);
    void set(std::string_view path, const char* text) { set(path, std::string_view{text}); }
    void set(std::string_view path, const std::string& text) { set(path, std::string_view{text}); }
    void set(std::string_view path, glm::ivec2 size_px);                        ///< an array of two whole numbers
    void set(std::string_view path, std::span<const double> numbers);           ///< an array
    void set(std::string_view path, const std::vector<std::string>& texts);     ///< an array
    void set(std::string_view path, const Distribution& distribution);          ///< {"mean","min","p5",...}
    void set(std::string_view path, const std::optional<double>& number);       ///< null when empty
    void set(std::string_view path, const std::optional<Distribution>& maybe);  ///< null when empty
    void set_null(std::string_view path);
    void set(std::string_view path, const Report& subtree);  ///< a copy of all that `subtree` holds
    /// One more element of the array at `path`, which begins empty.
    void append(std::string_view path, const Report& element);

    /// Indented, ending with a line break. Bytes that are no UTF-8 (a file name) are replaced.
    [[nodiscard]] std::string text() const;
    /// Through a temporary file; the folder must exist.
    [[nodiscard]] Status write(const std::filesystem::path& path) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

/// `machine{cpu,cores,gl_renderer,gl_version}`; the GL keys are null without a context.
void describe_machine(Report& report, const gl::Context* context);
void describe_machine(Report& report, const Machine& machine);
/// `scene{name,triangles,objects,movers}`: triangles and objects over instances.
void describe_scene(Report& report, const scene::Scene& scene);
/// `settings{...}`, `method`, `size_px`: everything given or defaulted that bears on the result.
void describe_settings(Report& report, const Options& options);

/// Makes `folder` and its parents, and makes sure that a file can be written there: trouble shows before the long work.
[[nodiscard]] Status make_output_folder(const std::filesystem::path& folder);

/// The file's folder exists and takes files, and the file is no folder: trouble shows before the long work.
[[nodiscard]] Status check_output_file(const std::filesystem::path& path);

/// Text as a file, through a temporary one.
[[nodiscard]] Status write_text(const std::filesystem::path& path, std::string_view text);

}  // namespace lw
