// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file itkLabelImageToTetrahedralMeshFilter.h
 * @brief Label image to conforming, quality tetrahedral mesh, as a filter of ITK.
 */
#ifndef itkLabelImageToTetrahedralMeshFilter_h
#define itkLabelImageToTetrahedralMeshFilter_h

#include "voxplexLabelMeshing.h"

#include "itkImageToMeshFilter.h"

#include <cstdint>
#include <type_traits>

namespace itk
{

/**
 * @class LabelImageToTetrahedralMeshFilter
 * @brief Label image to conforming, quality tetrahedral mesh.
 *
 * Every label of a segmented image becomes a set of tetrahedra; those of neighbouring labels share
 * the nodes of their common interface, which is smooth, not a staircase. The method, its guarantees
 * and its defaults are those of vtkImageToTetMeshFilter; neither VTK nor its libraries are needed.
 *
 * @par Input
 * An itk::Image of three dimensions and any arithmetic type but bool: one label per voxel, 0 is
 * background. Labels are whole numbers, none of them negative. The filter asks for the whole image.
 *
 * @par Output
 * Cells are itk::TetrahedronCell, of positive volume for right-handed and left-handed directions.
 * Points lie in the physical space of the image; each is used by a cell. The cell data is the label.
 * CellPixelType must hold each label that is meshed, or there is an exception. Coordinates of type
 * float, ITK's default, have seven digits: take double if the origin is far away compared with Delta.
 *
 * @par Errors
 * itk::ExceptionObject says what is wrong and what to do: of the image (no labels, grey values) or of
 * a parameter out of its range. The output is then empty. Labels that the mesh lacks, and what else
 * differs from the image, are warnings (itkWarningMacro).
 *
 * @par Progress
 * itk::ProgressEvent comes from the thread that updates the filter, at least ten times a second. If an
 * observer calls AbortGenerateDataOn(), meshing stops within a second with itk::ProcessAborted.
 *
 * @par Threads
 * The filter takes as many as GetNumberOfWorkUnits() says, but not more than the
 * GetMaximumNumberOfThreads() of its MultiThreader. With one work unit, or with Reproducible, every run
 * makes the same mesh.
 */
template <typename TInputImage, typename TOutputMesh>
class ITK_TEMPLATE_EXPORT LabelImageToTetrahedralMeshFilter
  : public ImageToMeshFilter<TInputImage, TOutputMesh>
  , private voxplex::LabelMeshingParameters // m_Delta and so on
{
public:
  ITK_DISALLOW_COPY_AND_MOVE(LabelImageToTetrahedralMeshFilter);

  ///@{
  /** As in all filters of ITK. */
  using Self = LabelImageToTetrahedralMeshFilter;
  using Superclass = ImageToMeshFilter<TInputImage, TOutputMesh>;
  using Pointer = SmartPointer<Self>;
  using ConstPointer = SmartPointer<const Self>;
  using InputImageType = TInputImage;
  using OutputMeshType = TOutputMesh;
  itkNewMacro(Self);
  const char* GetNameOfClass() const override { return "LabelImageToTetrahedralMeshFilter"; }
  ///@}

  static_assert(TInputImage::ImageDimension == 3, "The image must have three dimensions.");
  static_assert(TOutputMesh::PointDimension == 3, "The mesh must have three dimensions.");
  static_assert(std::is_arithmetic<typename TInputImage::PixelType>::value &&
      !std::is_same<typename TInputImage::PixelType, bool>::value,
    "Pixels must be numbers.");

  ///@{
  /**
   * The sampling distance of interfaces, in the unit of the spacing. The edges of their triangles are
   * about one to two times as long. 0, the default: twice the edge of a cube of a voxel's volume.
   */
  itkSetMacro(Delta, double);
  itkGetConstMacro(Delta, double);
  ///@}

  ///@{
  /** The number of tetrahedra, to within a tenth, in place of Delta. 0, the default: Delta counts. */
  itkSetMacro(NumberOfElements, std::int64_t);
  itkGetConstMacro(NumberOfElements, std::int64_t);
  ///@}

  ///@{
  /** Upper bound of circumradius over shortest edge. Default 2; below 1.93 only with Force. */
  itkSetMacro(RadiusEdgeRatio, double);
  itkGetConstMacro(RadiusEdgeRatio, double);
  ///@}

  ///@{
  /** Lower bound of the angles of triangles of interfaces, 0 to 30 degrees. Default 30. */
  itkSetMacro(FacetAngle, double);
  itkGetConstMacro(FacetAngle, double);
  ///@}

  ///@{
  /** Standard deviation of the smoothing of voxel stairs, 0 to 5 voxels. Default 1; 0: none. */
  itkSetMacro(SmoothingSigma, double);
  itkGetConstMacro(SmoothingSigma, double);
  ///@}

  ///@{
  /**
   * Connected components of less volume get the label around them. The unit is that of the spacing, to
   * the third power. Default 0: none is left out.
   */
  itkSetMacro(MinimumComponentVolume, double);
  itkGetConstMacro(MinimumComponentVolume, double);
  ///@}

  ///@{
  /** Sample components as finely as their thickness requires, for every Delta. Default off. */
  itkSetMacro(ExactComponents, bool);
  itkGetConstMacro(ExactComponents, bool);
  itkBooleanMacro(ExactComponents);
  ///@}

  ///@{
  /** Improve shapes after refinement: dihedral angles of 18 to 150 degrees mostly. Default on. */
  itkSetMacro(Optimise, bool);
  itkGetConstMacro(Optimise, bool);
  itkBooleanMacro(Optimise);
  ///@}

  ///@{
  /** Make the same mesh, bit for bit, with any number of threads. Default off. */
  itkSetMacro(Reproducible, bool);
  itkGetConstMacro(Reproducible, bool);
  itkBooleanMacro(Reproducible);
  ///@}

  ///@{
  /**
   * Go on where the mesh is estimated not to fit in memory, where labels look like grey values, and
   * with values beyond their limits. Default off.
   */
  itkSetMacro(Force, bool);
  itkGetConstMacro(Force, bool);
  itkBooleanMacro(Force);
  ///@}

  ///@{
  /** The labels to mesh; the others become background. By default all are meshed. */
  void AddLabel(std::int64_t label);
  void RemoveAllLabels();
  ///@}

protected:
  LabelImageToTetrahedralMeshFilter() = default;
  ~LabelImageToTetrahedralMeshFilter() override = default;

  void GenerateData() override;
  void PrintSelf(std::ostream& os, Indent indent) const override;

private:
  voxplex::LabelledTetrahedra Mesh();
  void Fill(const voxplex::LabelledTetrahedra& mesh);
};

} // namespace itk

#ifndef ITK_MANUAL_INSTANTIATION
#include "itkLabelImageToTetrahedralMeshFilter.hxx"
#endif

#endif
