// SISL's nearest points: `global` is s1953 and s1954, `local` is s1957 and s1958.

#include "serve.hpp"

#include <cmath>

#include <sisl.h>

namespace {

/// The geometric resolution that is asked for, as a share of the entity's size: of 1e-6 to 1e-12 the one with the most right answers, at no cost in time.
constexpr double kResolution = 1e-11;

/// Coefficients as SISL wants them: the first index runs fastest, rational ones are weighted.
std::vector<double> coefficients(const Entity& entity) {
    std::vector<double> out;
    for (int j = 0; j < entity.columns; ++j) {
        for (int i = 0; i < entity.rows; ++i) {
            const std::size_t at = static_cast<std::size_t>(i) * entity.columns + j;
            const double weight = entity.weights[at];
            for (const double coordinate : entity.points[at]) out.push_back(coordinate * weight);
            if (entity.is_rational) out.push_back(weight);
        }
    }
    return out;
}

double length(const double* point, const Point& p) {
    return std::hypot(point[0] - p[0], point[1] - p[1], point[2] - p[2]);
}

class OnCurve : public Method {
public:
    OnCurve(const Entity& entity, bool is_global) : is_global_(is_global), resolution_(kResolution * entity.size) {
        std::vector<double> knots = entity.knots[0], net = coefficients(entity);
        curve_ = newCurve(entity.rows, entity.degree[0] + 1, knots.data(), net.data(), entity.is_rational ? 2 : 1, 3, 1);
        if (curve_ == nullptr) throw std::runtime_error("newCurve gave nothing");
    }
    ~OnCurve() override { freeCurve(curve_); }

    Answer ask(const Point& p) override {
        Point point = p;
        int status = 0;
        Answer answer;
        if (!is_global_) {
            s1957(curve_, point.data(), 3, 0.0, resolution_, &answer.u, &answer.distance, &status);
            answer.is_found = status >= 0;
            return answer;
        }
        int points = 0, curves = 0, left = 0;
        double* parameters = nullptr;
        SISLIntcurve** continua = nullptr;
        s1953(curve_, point.data(), 3, 0.0, resolution_, &points, &parameters, &curves, &continua, &status);
        if (status >= 0 && points + curves > 0) {
            answer.u = points > 0 ? parameters[0] : continua[0]->epar1[0];
            double foot[3];
            s1227(curve_, 0, answer.u, &left, foot, &status);
            answer.distance = length(foot, p);
            answer.is_found = status >= 0;
        }
        std::free(parameters);
        if (continua != nullptr) freeIntcrvlist(continua, curves);
        return answer;
    }

private:
    bool is_global_;
    double resolution_;
    SISLCurve* curve_;
};

class OnSurface : public Method {
public:
    OnSurface(const Entity& entity, bool is_global) : is_global_(is_global), resolution_(kResolution * entity.size) {
        std::vector<double> knots_u = entity.knots[0], knots_v = entity.knots[1], net = coefficients(entity);
        surface_ = newSurf(entity.rows, entity.columns, entity.degree[0] + 1, entity.degree[1] + 1, knots_u.data(), knots_v.data(),
                           net.data(), entity.is_rational ? 2 : 1, 3, 1);
        if (surface_ == nullptr) throw std::runtime_error("newSurf gave nothing");
    }
    ~OnSurface() override { freeSurf(surface_); }

    Answer ask(const Point& p) override {
        Point point = p;
        int status = 0;
        Answer answer;
        double at[2] = {0.0, 0.0};
        if (!is_global_) {
            s1958(surface_, point.data(), 3, 0.0, resolution_, at, &answer.distance, &status);
            answer.u = at[0];
            answer.v = at[1];
            answer.is_found = status >= 0;
            return answer;
        }
        int points = 0, curves = 0, left_u = 0, left_v = 0;
        double* parameters = nullptr;
        SISLIntcurve** continua = nullptr;
        s1954(surface_, point.data(), 3, 0.0, resolution_, &points, &parameters, &curves, &continua, &status);
        if (status >= 0 && points + curves > 0) {
            const double* found = points > 0 ? parameters : continua[0]->epar1;
            at[0] = answer.u = found[0];
            at[1] = answer.v = found[1];
            double foot[3];
            s1424(surface_, 0, 0, at, &left_u, &left_v, foot, &status);
            answer.distance = length(foot, p);
            answer.is_found = status >= 0;
        }
        std::free(parameters);
        if (continua != nullptr) freeIntcrvlist(continua, curves);
        return answer;
    }

private:
    bool is_global_;
    double resolution_;
    SISLSurf* surface_;
};

}  // namespace

int main(int argc, char** argv) {
    return serve(argc, argv, [](const std::string& method, const Entity& entity) -> std::unique_ptr<Method> {
        const bool is_global = method == "global";
        if (entity.is_surface) return std::make_unique<OnSurface>(entity, is_global);
        return std::make_unique<OnCurve>(entity, is_global);
    });
}
