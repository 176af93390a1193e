# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a C++ package (build types ament_cmake and cmake)."""

from __future__ import annotations

from ros2pkg.creation.package import NewPackage

_NODE = """\
#include <cstdio>

int main(int argc, char ** argv)
{{
  (void) argc;
  (void) argv;

  printf("hello world {name} package\\n");
  return 0;
}}
"""
_HEADER = """\
#ifndef {guard}
#define {guard}

#include "{name}/visibility_control.h"

namespace {name}
{{

class {class_name}
{{
public:
  {class_name}();

  virtual ~{class_name}();
}};

}}  // namespace {name}

#endif  // {guard}
"""
_SOURCE = """\
#include "{name}/{library}.hpp"

namespace {name}
{{

{class_name}::{class_name}()
{{
}}

{class_name}::~{class_name}()
{{
}}

}}  // namespace {name}
"""
_VISIBILITY = """\
#ifndef {guard}
#define {guard}

// Which symbols a shared library shows, as https://gcc.gnu.org/wiki/Visibility has it.
#if defined _WIN32 || defined __CYGWIN__
  #ifdef {upper}_BUILDING_LIBRARY
    #define {upper}_PUBLIC __declspec(dllexport)
  #else
    #define {upper}_PUBLIC __declspec(dllimport)
  #endif
#else
  #define {upper}_PUBLIC __attribute__ ((visibility("default")))
#endif

#endif  // {guard}
"""
_HEAD = """\
cmake_minimum_required(VERSION 3.8)
project({name})

if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  add_compile_options(-Wall -Wextra -Wpedantic)
endif()

"""
_LINT = """\
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  # Delete the next line when every source file has its copyright notice.
  set(ament_cmake_copyright_FOUND TRUE)
  # Delete the next line when the package lies in a git repository, with a copyright notice.
  set(ament_cmake_cpplint_FOUND TRUE)
  ament_lint_auto_find_test_dependencies()
endif()

"""


def files(package: NewPackage) -> dict[str, str]:
    """Return the texts of the package's files by their paths."""
    name, library = package.name, package.library_name
    found = {'CMakeLists.txt': _cmake_lists(package)}
    if package.node_name:
        found[f'src/{package.node_name}.cpp'] = _NODE.format(name=name)
    if library:
        class_name = ''.join(part.capitalize() for part in library.split('_'))
        values = {'name': name, 'library': library, 'class_name': class_name}
        upper = name.upper()
        guard = f'{upper}__{library.upper()}_HPP_'
        found[f'include/{name}/{library}.hpp'] = _HEADER.format(guard=guard, **values)
        found[f'src/{library}.cpp'] = _SOURCE.format(**values)
        found[f'include/{name}/visibility_control.h'] = _VISIBILITY.format(
            upper=upper, guard=f'{upper}__VISIBILITY_CONTROL_H_'
        )
    return found


def _cmake_lists(package: NewPackage) -> str:
    ament = package.build_type == 'ament_cmake'
    required = [*package.buildtool_dependencies, *package.dependencies]
    text = _HEAD.format(name=package.name) + '# find dependencies\n'
    text += ''.join(f'find_package({name} REQUIRED)\n' for name in required) + '\n'
    if package.library_name:
        text += _target(package, package.library_name, 'library')
    if package.node_name:
        text += _target(package, package.node_name, 'executable')
    if ament:
        text += _LINT + 'ament_package()\n'
    return text


def _target(package: NewPackage, target: str, kind: str) -> str:
    lines = [
        f'add_{kind}({target} src/{target}.cpp)',
        f'target_include_directories({target} PUBLIC',
        '  $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>',
        '  $<INSTALL_INTERFACE:include/${PROJECT_NAME}>)',
        f'target_compile_features({target} PUBLIC c_std_99 cxx_std_17)',
    ]
    if package.dependencies and package.build_type == 'ament_cmake':
        lines.append(f'ament_target_dependencies({target} {" ".join(package.dependencies)})')
    if kind == 'library':
        upper = package.name.upper()
        lines += [
            f'target_compile_definitions({target} PRIVATE "{upper}_BUILDING_LIBRARY")',
            'install(DIRECTORY include/ DESTINATION include/${PROJECT_NAME})',
            f'install(TARGETS {target} EXPORT export_${{PROJECT_NAME}}',
            '  ARCHIVE DESTINATION lib LIBRARY DESTINATION lib RUNTIME DESTINATION bin)',
        ]
        if package.build_type == 'ament_cmake':
            lines.append('ament_export_targets(export_${PROJECT_NAME} HAS_LIBRARY_TARGET)')
    else:
        lines.append(f'install(TARGETS {target} DESTINATION lib/${{PROJECT_NAME}})')
    return '\n'.join(lines) + '\n\n'
