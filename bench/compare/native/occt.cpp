// OpenCASCADE's nearest points.
//
// `extrema`: GeomAPI_ProjectPointOnSurf or OnCurve over the domain, made once, the ends or edges and corners by hand beside it, since it gives feet whose
// residual is perpendicular alone. `shape-analysis`: ShapeAnalysis_Surface::ValueOfUV, ShapeAnalysis_Curve::Project. `cold`: Init and Perform of the
// first for every query, edges left out. `elementary` and `elementary-bare`: `extrema` on the library's own surface or curve of the
// entity's shape, with the edges and without.

#include "serve.hpp"

#include <limits>
#include <stdexcept>

#include <Extrema_ExtAlgo.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <GeomAPI_ProjectPointOnCurve.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <ShapeAnalysis_Curve.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <Standard_Failure.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>

namespace {

gp_Pnt at(const Point& p) {
    return gp_Pnt(p[0], p[1], p[2]);
}

struct Knots {
    TColStd_Array1OfReal values;
    TColStd_Array1OfInteger multiplicities;
};

Knots distinct(const std::vector<double>& knots) {
    std::vector<double> values;
    std::vector<int> multiplicities;
    for (const double knot : knots) {
        if (values.empty() || knot != values.back()) {
            values.push_back(knot);
            multiplicities.push_back(0);
        }
        ++multiplicities.back();
    }
    const int count = static_cast<int>(values.size());
    Knots out{TColStd_Array1OfReal(1, count), TColStd_Array1OfInteger(1, count)};
    for (int i = 0; i < count; ++i) {
        out.values(i + 1) = values[i];
        out.multiplicities(i + 1) = multiplicities[i];
    }
    return out;
}

Handle(Geom_Curve) spline_curve(const Entity& entity) {
    TColgp_Array1OfPnt poles(1, entity.rows);
    TColStd_Array1OfReal weights(1, entity.rows);
    for (int i = 0; i < entity.rows; ++i) {
        poles(i + 1) = at(entity.points[i]);
        weights(i + 1) = entity.weights[i];
    }
    const Knots knots = distinct(entity.knots[0]);
    if (entity.is_rational) return new Geom_BSplineCurve(poles, weights, knots.values, knots.multiplicities, entity.degree[0]);
    return new Geom_BSplineCurve(poles, knots.values, knots.multiplicities, entity.degree[0]);
}

Handle(Geom_Surface) spline_surface(const Entity& entity) {
    TColgp_Array2OfPnt poles(1, entity.rows, 1, entity.columns);
    TColStd_Array2OfReal weights(1, entity.rows, 1, entity.columns);
    for (int i = 0; i < entity.rows; ++i) {
        for (int j = 0; j < entity.columns; ++j) {
            const std::size_t k = static_cast<std::size_t>(i) * entity.columns + j;
            poles(i + 1, j + 1) = at(entity.points[k]);
            weights(i + 1, j + 1) = entity.weights[k];
        }
    }
    const Knots u = distinct(entity.knots[0]), v = distinct(entity.knots[1]);
    const auto [p, q] = entity.degree;
    if (entity.is_rational) {
        return new Geom_BSplineSurface(poles, weights, u.values, v.values, u.multiplicities, v.multiplicities, p, q);
    }
    return new Geom_BSplineSurface(poles, u.values, v.values, u.multiplicities, v.multiplicities, p, q);
}

/// A surface with the part of its parameters that is meant.
struct Patch {
    Handle(Geom_Surface) surface;
    std::array<double, 2> u, v;
};

struct Arc {
    Handle(Geom_Curve) curve;
    std::array<double, 2> u;
};

gp_Ax3 frame(const Shape& shape) {
    const auto direction = [](const Point& d) { return gp_Dir(d[0], d[1], d[2]); };
    return gp_Ax3(at(shape.origin), direction(shape.axis), direction(shape.x_direction));
}

Patch elementary_surface(const Shape& shape) {
    const std::vector<double>& n = shape.numbers;
    const gp_Ax3 axes = frame(shape);
    if (shape.name == "plane") return {new Geom_Plane(axes), {0.0, n[0]}, {0.0, n[1]}};
    if (shape.name == "cylinder") return {new Geom_CylindricalSurface(axes, n[0]), {0.0, n[1]}, {0.0, n[2]}};
    if (shape.name == "cone") return {new Geom_ConicalSurface(axes, n[1], n[0]), {0.0, n[2]}, {0.0, n[3]}};
    if (shape.name == "sphere") return {new Geom_SphericalSurface(axes, n[0]), {0.0, n[1]}, {n[2], n[2] + n[3]}};
    if (shape.name == "torus") return {new Geom_ToroidalSurface(axes, n[0], n[1]), {0.0, n[2]}, {n[3], n[3] + n[4]}};
    throw std::runtime_error("no elementary surface is called " + shape.name);
}

Arc elementary_curve(const Shape& shape) {
    if (shape.name != "circle") throw std::runtime_error("no elementary curve is called " + shape.name);
    return {new Geom_Circle(frame(shape).Ax2(), shape.numbers[0]), {0.0, shape.numbers[1]}};
}

/// Keeps the nearer of two answers.
void improve(Answer& best, double distance, double u, double v) {
    if (!best.is_found || distance < best.distance) best = {true, distance, u, v};
}

/// GeomAPI_ProjectPointOnCurve, and the ends by hand where asked for.
class OnCurve : public Method {
public:
    OnCurve(const Arc& arc, bool has_ends) : arc_(arc) {
        projector_.Init(arc.curve, arc.u[0], arc.u[1]);
        for (const double u : arc.u) {
            if (has_ends) ends_.push_back({u, arc.curve->Value(u)});
        }
    }

    Answer ask(const Point& p) override {
        const gp_Pnt point = at(p);
        Answer best;
        try {
            projector_.Perform(point);
            if (projector_.NbPoints() > 0) improve(best, projector_.LowerDistance(), projector_.LowerDistanceParameter(), 0.0);
        } catch (const Standard_Failure&) {
        }
        for (const End& end : ends_) improve(best, point.Distance(end.point), end.u, 0.0);
        return best;
    }

private:
    struct End {
        double u;
        gp_Pnt point;
    };
    Arc arc_;
    GeomAPI_ProjectPointOnCurve projector_;
    std::vector<End> ends_;
};

/// GeomAPI_ProjectPointOnSurf with the tree, and the edges with their ends by hand where asked for.
class OnSurface : public Method {
public:
    OnSurface(const Patch& patch, bool has_edges, double size) : patch_(patch) {
        projector_.Init(patch.surface, patch.u[0], patch.u[1], patch.v[0], patch.v[1], Extrema_ExtAlgo_Tree);
        if (!has_edges) return;
        for (const double u : patch.u) add_edge({patch.surface->UIso(u), patch.v}, {u, 0.0}, true, size);
        for (const double v : patch.v) add_edge({patch.surface->VIso(v), patch.u}, {0.0, v}, false, size);
        for (const double u : patch.u) {
            for (const double v : patch.v) corners_.push_back({u, v, patch.surface->Value(u, v)});
        }
    }

    Answer ask(const Point& p) override {
        const gp_Pnt point = at(p);
        Answer best;
        try {
            projector_.Perform(point);
            if (projector_.NbPoints() > 0) {
                double u = 0.0, v = 0.0;
                projector_.LowerDistanceParameters(u, v);
                improve(best, projector_.LowerDistance(), u, v);
            }
        } catch (const Standard_Failure&) {
        }
        for (Edge& edge : edges_) {
            const Answer found = edge.curve->ask(p);
            if (found.is_found) improve(best, found.distance, edge.is_along_v ? edge.u : found.u, edge.is_along_v ? found.u : edge.v);
        }
        for (const Corner& corner : corners_) improve(best, point.Distance(corner.point), corner.u, corner.v);
        return best;
    }

private:
    struct Edge {
        double u, v;
        bool is_along_v;
        std::unique_ptr<OnCurve> curve;
    };
    struct Corner {
        double u, v;
        gp_Pnt point;
    };

    /// Edges that are one point are left to the corners.
    void add_edge(const Arc& arc, std::array<double, 2> where, bool is_along_v, double size) {
        const gp_Pnt first = arc.curve->Value(arc.u[0]);
        const auto apart = [&](double share) {
            return first.Distance(arc.curve->Value(arc.u[0] + share * (arc.u[1] - arc.u[0]))) > 1e-9 * size;
        };
        if (apart(0.31) || apart(0.62)) edges_.push_back({where[0], where[1], is_along_v, std::make_unique<OnCurve>(arc, false)});
    }

    Patch patch_;
    GeomAPI_ProjectPointOnSurf projector_;
    std::vector<Edge> edges_;
    std::vector<Corner> corners_;
};

class AnalysedCurve : public Method {
public:
    AnalysedCurve(Handle(Geom_Curve) curve, double precision) : curve_(curve), precision_(precision) {}

    Answer ask(const Point& p) override {
        Answer answer;
        gp_Pnt foot;
        try {
            answer.distance = ShapeAnalysis_Curve().Project(curve_, at(p), precision_, foot, answer.u);
            answer.is_found = true;
        } catch (const Standard_Failure&) {
        }
        return answer;
    }

private:
    Handle(Geom_Curve) curve_;
    double precision_;
};

class AnalysedSurface : public Method {
public:
    AnalysedSurface(Handle(Geom_Surface) surface, double precision) : analysis_(new ShapeAnalysis_Surface(surface)), precision_(precision) {}

    Answer ask(const Point& p) override {
        Answer answer;
        try {
            const gp_Pnt2d found = analysis_->ValueOfUV(at(p), precision_);
            answer = {true, analysis_->Gap(), found.X(), found.Y()};
        } catch (const Standard_Failure&) {
        }
        return answer;
    }

private:
    Handle(ShapeAnalysis_Surface) analysis_;
    double precision_;
};

/// Init and Perform for every query; the geometry itself keeps nothing of a query.
class Cold : public Method {
public:
    Cold(Handle(Geom_Curve) curve, Handle(Geom_Surface) surface) : curve_(curve), surface_(surface) {}

    Answer ask(const Point& p) override {
        if (!surface_.IsNull()) return OnSurface(whole(surface_), false, 0.0).ask(p);
        return OnCurve({curve_, {curve_->FirstParameter(), curve_->LastParameter()}}, false).ask(p);
    }

    static Patch whole(Handle(Geom_Surface) surface) {
        Patch patch{surface, {}, {}};
        surface->Bounds(patch.u[0], patch.u[1], patch.v[0], patch.v[1]);
        return patch;
    }

private:
    Handle(Geom_Curve) curve_;
    Handle(Geom_Surface) surface_;
};

/// The share of the size that ShapeAnalysis takes as its precision.
constexpr double kPrecision = 1e-9;

std::unique_ptr<Method> on_curve(const std::string& method, const Entity& entity) {
    if (method == "elementary") return std::make_unique<OnCurve>(elementary_curve(entity.shape), true);
    if (method == "elementary-bare") return std::make_unique<OnCurve>(elementary_curve(entity.shape), false);
    Handle(Geom_Curve) curve = spline_curve(entity);
    if (method == "extrema") return std::make_unique<OnCurve>(Arc{curve, {curve->FirstParameter(), curve->LastParameter()}}, true);
    if (method == "shape-analysis") return std::make_unique<AnalysedCurve>(curve, kPrecision * entity.size);
    if (method == "cold") return std::make_unique<Cold>(curve, nullptr);
    throw std::runtime_error("no method is called " + method);
}

std::unique_ptr<Method> on_surface(const std::string& method, const Entity& entity) {
    if (method == "elementary") return std::make_unique<OnSurface>(elementary_surface(entity.shape), true, entity.size);
    if (method == "elementary-bare") return std::make_unique<OnSurface>(elementary_surface(entity.shape), false, entity.size);
    Handle(Geom_Surface) surface = spline_surface(entity);
    if (method == "extrema") return std::make_unique<OnSurface>(Cold::whole(surface), true, entity.size);
    if (method == "shape-analysis") return std::make_unique<AnalysedSurface>(surface, kPrecision * entity.size);
    if (method == "cold") return std::make_unique<Cold>(nullptr, surface);
    throw std::runtime_error("no method is called " + method);
}

}  // namespace

int main(int argc, char** argv) {
    return serve(argc, argv, [](const std::string& method, const Entity& entity) {
        return entity.is_surface ? on_surface(method, entity) : on_curve(method, entity);
    });
}
