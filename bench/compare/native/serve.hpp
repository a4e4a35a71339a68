// What the native programs share: the file that they read, and the lines that they write.
//
//   PROGRAM METHOD FILE [--from ROW] [--skip ROW]...
//
// prints `setup NANOSECONDS BYTES`, then from `--from` on a line for every row of the file, `answer DISTANCE U V` or `none`, then `done`. Every line is
// flushed: where the library aborts the process, the parent knows the row. Afterwards every line `pass STRIDE` on the standard input is answered with
// `pass NANOSECONDS`, the time of every STRIDE-th row but those that are to be skipped.

#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <malloc.h>

using Point = std::array<double, 3>;

/// A shape in the library's own terms: its frame, and numbers whose meaning depends on its name.
struct Shape {
    std::string name;
    Point origin, axis, x_direction;
    std::vector<double> numbers;
};

/// An entity as the file holds it. Of a surface, point (i, j) stands at `points[i * columns + j]`, `i` along u; points are not weighted.
struct Entity {
    bool is_surface = false;
    bool is_rational = false;
    double size = 0.0;
    std::array<int, 2> degree{};
    std::array<std::vector<double>, 2> knots;
    int rows = 0;
    int columns = 1;
    std::vector<Point> points;
    std::vector<double> weights;
    Shape shape;
};

/// What a library answers.
struct Answer {
    bool is_found = false;
    double distance = 0.0;
    double u = 0.0;
    double v = 0.0;
};

/// A method made ready for one entity.
struct Method {
    virtual ~Method() = default;
    virtual Answer ask(const Point& p) = 0;
};

using Maker = std::function<std::unique_ptr<Method>(const std::string& method, const Entity& entity)>;

inline std::vector<double> read_numbers(std::istream& in) {
    std::size_t count = 0;
    in >> count;
    std::vector<double> numbers(count);
    for (double& number : numbers) in >> number;
    return numbers;
}

inline Point read_point(std::istream& in) {
    Point p{};
    in >> p[0] >> p[1] >> p[2];
    return p;
}

inline Entity read_entity(std::istream& in) {
    Entity entity;
    std::string kind;
    in >> kind >> entity.is_rational >> entity.size;
    entity.is_surface = kind == "surface";
    in >> entity.degree[0] >> entity.degree[1] >> entity.rows >> entity.columns;
    for (auto& knots : entity.knots) knots = read_numbers(in);
    for (int k = 0; k < entity.rows * entity.columns; ++k) {
        entity.points.push_back(read_point(in));
        double weight = 1.0;
        in >> weight;
        entity.weights.push_back(weight);
    }
    in >> entity.shape.name;
    entity.shape.origin = read_point(in);
    entity.shape.axis = read_point(in);
    entity.shape.x_direction = read_point(in);
    entity.shape.numbers = read_numbers(in);
    return entity;
}

inline long long nanoseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start).count();
}

/// Keeps the compiler from leaving an answer out.
inline void keep(const Answer& answer) {
    asm volatile("" : : "r"(&answer) : "memory");
}

inline int serve(int argc, char** argv, const Maker& make) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: %s METHOD FILE [--from ROW] [--skip ROW]...\n", argv[0]);
        return 2;
    }
    std::size_t from = 0;
    std::set<std::size_t> skipped;
    for (int i = 3; i + 1 < argc; i += 2) {
        const std::size_t row = std::strtoull(argv[i + 1], nullptr, 10);
        if (std::string(argv[i]) == "--from") from = row;
        else skipped.insert(row);
    }
    std::ifstream file(argv[2]);
    const Entity entity = read_entity(file);
    std::size_t count = 0;
    file >> count;
    std::vector<Point> rows(count);
    for (Point& row : rows) row = read_point(file);
    if (!file || count == 0) {
        std::fprintf(stderr, "%s holds no entity with queries\n", argv[2]);
        return 2;
    }

    std::size_t first = 0;
    while (skipped.count(first) != 0 && first + 1 < count) ++first;
    std::unique_ptr<Method> method;
    std::array<long long, 3> setups{};
    // counted at the first: freed blocks that the allocator keeps at hand count as held afterwards
    const std::size_t before = mallinfo2().uordblks;
    std::size_t after = before;
    for (long long& setup : setups) {
        method.reset();
        const auto start = std::chrono::steady_clock::now();
        method = make(argv[1], entity);
        keep(method->ask(rows[first]));
        setup = nanoseconds_since(start);
        if (after == before) after = mallinfo2().uordblks;
    }
    std::sort(setups.begin(), setups.end());
    std::printf("setup %lld %zu\n", setups[1], after > before ? after - before : 0);
    std::fflush(stdout);

    for (std::size_t row = from; row < count; ++row) {
        const Answer answer = method->ask(rows[row]);
        if (answer.is_found) std::printf("answer %.17g %.17g %.17g\n", answer.distance, answer.u, answer.v);
        else std::printf("none\n");
        std::fflush(stdout);
    }
    std::printf("done\n");
    std::fflush(stdout);

    std::string word;
    std::size_t stride = 1;
    while (std::cin >> word >> stride) {
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t row = 0; row < count; row += stride) {
            if (skipped.empty() || skipped.count(row) == 0) keep(method->ask(rows[row]));
        }
        std::printf("pass %lld\n", nanoseconds_since(start));
        std::fflush(stdout);
    }
    return 0;
}
